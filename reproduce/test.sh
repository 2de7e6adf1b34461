#!/usr/bin/env bash
# Installs what the tests need and runs them. Arguments go to `cargo test`. Tests and experiments share one build. The Python package
# has tests of its own, python/tests, which .ci/run runs.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

"$root/reproduce/install.sh"
cargo test --release --locked --workspace --exclude bodyschema-python --manifest-path "$root/Cargo.toml" "$@"
