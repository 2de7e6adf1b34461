#!/usr/bin/env bash
# Experiment 1, over the dimensions of the body map (section 5). See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" exp1 reproduce exp1 "$@"
