#!/usr/bin/env bash
# Sensitivity analysis: varies each setting that the paper leaves open, by the design in sensitivity.toml. Writes study.md with its
# figures and tables into results/sensitivity. Takes about an hour on two cores; an interrupted run continues. `--only NAME` runs a
# single factor of the design, such as quantisation. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" sensitivity study "$root/reproduce/sensitivity.toml" "$@"
