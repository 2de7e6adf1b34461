#!/usr/bin/env bash
# The search for the default configuration, by the score in search.toml. Takes about four hours on two cores; an interrupted
# search continues. Writes results/search. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" search search "$@"
