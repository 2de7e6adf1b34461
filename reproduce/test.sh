#!/usr/bin/env bash
# Installs what the tests need and runs them. Arguments go to `cargo test`.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

"$root/reproduce/install.sh"
cargo test --locked --workspace --manifest-path "$root/Cargo.toml" "$@"
