#!/usr/bin/env bash
# Moves a body for a short time, and draws the body schema from the reference body maps of both experiments, and compares with
# what stands beside them: whether the physics engine and the inference do on this machine what they did where the references were
# made. Takes half a minute after the build. Status: 0 they do, 1 they do not, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
manifest=(--release --locked --manifest-path "$root/Cargo.toml")

"$root/reproduce/install.sh" || exit 2
cargo build --quiet "${manifest[@]}" || exit 2

status=0
reference=$root/reproduce/reference/movement
out=$root/results/verify/movement
cargo run --quiet "${manifest[@]}" -- simulate --settings "$reference/settings.toml" --seed 3141 --out "$out"
cargo run --quiet "${manifest[@]}" -- verify "$out" --against "$reference" || status=$?
for experiment in exp1 exp2; do
    reference=$root/reproduce/reference/$experiment
    out=$root/results/verify/$experiment
    cargo run --quiet "${manifest[@]}" -- infer "$reference/body-map.npy" \
        --settings "$root/reproduce/equations.toml" --labels "$reference/labels.csv" --tree "$reference/tree.csv" --out "$out"
    cargo run --quiet "${manifest[@]}" -- verify "$out" --against "$reference/schema" || status=$?
done
exit "$status"
