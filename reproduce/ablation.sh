#!/usr/bin/env bash
# Ablation: what each departure of the authors' code changes, by the design in ablation.toml. An interrupted run continues.
# Writes results/ablation. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" ablation compare "$@"
