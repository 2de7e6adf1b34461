#!/usr/bin/env bash
# Experiment 2, over the ratios of motor coordination (section 6). See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" exp2 reproduce exp2 "$@"
