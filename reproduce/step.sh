#!/usr/bin/env bash
# Whether a shorter time step changes the results, by the design in step.toml. An interrupted run continues. Writes
# results/step. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" step study "$root/reproduce/step.toml" "$@"
