#!/usr/bin/env bash
# Whether the physics engine and the inference give the reference results on this machine. Simulates a short movement, samples
# body schemas from the reference body maps of both experiments, and compares both with reproduce/reference. Takes half a minute
# after the build. Status: 0 they agree, 1 they do not, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
manifest=(--release --locked --manifest-path "$root/Cargo.toml")

"$root/reproduce/build.sh" || exit 2

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
