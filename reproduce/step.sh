#!/usr/bin/env bash
# Whether a shorter step changes what is claimed, by the design in step.toml. Goes on where it was if it is stopped, and writes
# results/step. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" step compare --design "$root/reproduce/step.toml" "$@"
