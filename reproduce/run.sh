#!/usr/bin/env bash
# Installs what is missing, builds, and runs a subcommand of bodyschema. The first argument names the folder under
# results/ that its files go to unless --out says otherwise; all others are the subcommand's (see --help). Status: 0
# done (of an experiment: every claim reproduced), 1 some claim not, 2 on an error.
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
exec cargo run --quiet "${manifest[@]}" -- "$@" "${out[@]}"
