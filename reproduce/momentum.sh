#!/usr/bin/env bash
# Whether results depend on the engine's drift of angular momentum (an integration error), by the design in momentum.toml. An
# interrupted run continues. Writes results/momentum. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" momentum study "$root/reproduce/momentum.toml" "$@"
