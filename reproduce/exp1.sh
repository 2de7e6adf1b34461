#!/usr/bin/env bash
# Experiment 1, over the dimensions of the body map (section 5). See experiment.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/experiment.sh" exp1 "$@"
