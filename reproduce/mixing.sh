#!/usr/bin/env bash
# Compares the mixing of the split-merge sampler with that of the paper's sampler, tests whether it recovers the parts in
# simulations on which nothing was chosen, and whether its edge probabilities are calibrated. Writes results/mixing, or the
# folder that is given: mixing.sh [FOLDER].
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

"$root/reproduce/install.sh"
cargo run --quiet --release --locked --manifest-path "$root/Cargo.toml" --example mixing "${1:-$root/results/mixing}"
