#!/usr/bin/env bash
# Sensitivity analysis: varies each setting that the paper leaves open, by the design in sensitivity.toml. Writes sensitivity.md
# with its figures and table into results/sensitivity. Takes about an hour on two cores; an interrupted run continues. `--only
# NAME` runs a single [[part]] of the design, such as quantisation. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" sensitivity sensitivity "$@"
