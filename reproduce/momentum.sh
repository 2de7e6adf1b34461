#!/usr/bin/env bash
# Whether what is claimed rests on the angular momentum that the engine's steps add, by the design in momentum.toml. Goes on
# where it was if it is stopped, and writes results/momentum. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" momentum compare --design "$root/reproduce/momentum.toml" "$@"
