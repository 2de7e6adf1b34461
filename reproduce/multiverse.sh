#!/usr/bin/env bash
# Multiverse analysis: many reasonable interpretations of the paper, by the design in multiverse.toml. Takes hours; an
# interrupted run continues. Writes results/multiverse. With --shard I/N it runs a part, and with --gather it writes the tables
# of all parts. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" multiverse study "$root/reproduce/multiverse.toml" "$@"
