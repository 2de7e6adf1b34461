#!/usr/bin/env bash
# Varies what the paper leaves open, by the design in sensitivity.toml, and writes sensitivity.md with its pictures and
# table into results/sensitivity. Takes about an hour on two cores and goes on where it was if it is stopped; `--only
# NAME` runs one part alone, such as quantisation. See run.sh.
exec "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/run.sh" sensitivity sensitivity "$@"
