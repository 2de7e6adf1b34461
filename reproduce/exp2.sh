#!/usr/bin/env bash
# Experiment 2, over the ratios of motor coordination (section 6). See experiment.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/experiment.sh" exp2 "$@"
