#!/usr/bin/env bash
# Installs what is missing, builds, and runs a subcommand of bodyschema. The first argument names the folder under
# results/ that its files go to unless --out says otherwise; all others are the subcommand's (see --help). Status: that of the
# subcommand; of an experiment: 0 the headline is reproduced, 1 it is not, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
name=$1
shift

"$root/reproduce/build.sh" || exit 2

# A check of the installation leaves the results of a full run alone.
for argument in "$@"; do
    case $argument in --quick) name=$name-quick ;; esac
done
out=(--out "$root/results/$name")
for argument in "$@"; do
    case $argument in --out | --out=*) out=() ;; esac
done
exec cargo run --quiet --release --locked --manifest-path "$root/Cargo.toml" -- "$@" "${out[@]}"
