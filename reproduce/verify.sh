#!/usr/bin/env bash
# Draws the body schema from the reference body maps of both experiments, and compares with the draws that stand
# beside them: whether the inference does on this machine what it did where they were made. Takes half a minute
# after the build. Status: 0 it does, 1 it does not, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
manifest=(--release --locked --manifest-path "$root/Cargo.toml")

"$root/reproduce/install.sh" || exit 2
cargo build --quiet "${manifest[@]}" || exit 2

status=0
for experiment in exp1 exp2; do
    reference=$root/reproduce/reference/$experiment
    out=$root/results/verify/$experiment
    cargo run --quiet "${manifest[@]}" -- infer "$reference/body-map.npy" \
        --settings "$root/reproduce/equations.toml" --labels "$reference/labels.csv" --tree "$reference/tree.csv" --out "$out"
    cargo run --quiet "${manifest[@]}" -- verify "$out" --against "$reference/schema" || status=$?
done
exit "$status"
