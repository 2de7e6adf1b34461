#!/usr/bin/env bash
# Runs the registered confirmation of confirm.toml: both experiments, 100 simulations on a seed of its own, into results/confirm
# (--out FOLDER: elsewhere). A run that was stopped continues. Takes about an hour and a half on two cores, 0.8 GB of disk, and
# Python 3.11. Status: 0 the headline is confirmed, 1 it is not, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec python3 "$root/reproduce/confirm.py" "$@"
