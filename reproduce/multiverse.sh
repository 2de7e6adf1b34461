#!/usr/bin/env bash
# A multiverse of replications, by the design in multiverse.toml: takes hours, goes on where it was if it is stopped, and
# writes results/multiverse. With --shard I/N a part of it, and with --gather the tables of all parts. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" multiverse multiverse "$@"
