#!/usr/bin/env bash
# A smaller multiverse on held-out movements, by the design in multiverse-held-out.toml. reproduce/docs.py compares both. An
# interrupted run continues. Writes results/multiverse-held-out. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" multiverse-held-out study "$root/reproduce/multiverse-held-out.toml" "$@"
