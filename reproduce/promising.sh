#!/usr/bin/env bash
# Does any configuration reproduce all scored claims? Runs the ten most promising ones, by the design that promising.py wrote. An interrupted run
# continues. Writes results/promising. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" promising study "$root/reproduce/promising.toml" "$@"
