#!/usr/bin/env bash
# Which departure of the authors' code does what, by the design in ablation.toml. Goes on where it was if it is stopped, and
# writes results/ablation. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" ablation compare "$@"
