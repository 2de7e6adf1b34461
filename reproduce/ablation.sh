#!/usr/bin/env bash
# Ablation: what each departure of the authors' code changes, by the design in ablation.toml. An interrupted run continues.
# Writes results/ablation. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" ablation study "$root/reproduce/ablation.toml" "$@"
