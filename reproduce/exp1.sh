#!/usr/bin/env bash
# Experiment 1 from physics to the table of claims. All arguments go to `bodyschema reproduce exp1` (see
# --help); results go to results/exp1 unless --out says otherwise. Status: 0 every claim reproduced, 1 some
# claim not, 2 trouble.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
manifest=(--release --locked --manifest-path "$root/Cargo.toml")

"$root/reproduce/install.sh" || exit 2
cargo build --quiet "${manifest[@]}" || exit 2

out=(--out "$root/results/exp1")
for argument in "$@"; do
    case $argument in --out | --out=*) out=() ;; esac
done
exec cargo run --quiet "${manifest[@]}" -- reproduce exp1 "${out[@]}" "$@"
