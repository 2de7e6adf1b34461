#!/usr/bin/env bash
# How the split-merge sampler mixes beside the paper's, whether it finds the parts of bodies that nothing was chosen on, and
# whether its probabilities of edges are calibrated. Writes results/mixing (or the folder that is given).
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

"$root/reproduce/install.sh"
cargo run --quiet --release --locked --manifest-path "$root/Cargo.toml" --example mixing "${1:-$root/results/mixing}"
