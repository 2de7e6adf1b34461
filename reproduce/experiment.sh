#!/usr/bin/env bash
# An experiment from physics to the table of claims: installs what is missing, builds, runs. The first
# argument names the experiment, all others go to `bodyschema reproduce` (see --help); results go to
# results/NAME unless --out says otherwise. Status: 0 every claim reproduced, 1 some claim not, 2 trouble.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
manifest=(--release --locked --manifest-path "$root/Cargo.toml")
name=$1
shift

"$root/reproduce/install.sh" || exit 2
cargo build --quiet "${manifest[@]}" || exit 2

out=(--out "$root/results/$name")
for argument in "$@"; do
    case $argument in --out | --out=*) out=() ;; esac
done
exec cargo run --quiet "${manifest[@]}" -- reproduce "$name" "${out[@]}" "$@"
