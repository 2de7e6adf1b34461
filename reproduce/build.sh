#!/usr/bin/env bash
# Installs what is missing and builds the program, for the other scripts. The first build takes some minutes, and says so; on a
# terminal cargo shows its own bar. Status: 0 built, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

"$root/reproduce/install.sh" || exit 2
[ -x "${CARGO_TARGET_DIR:-$root/target}/release/bodyschema" ] ||
    echo "bodyschema: building the program, once; 3 to 7 minutes on two cores" >&2
quiet=(--quiet)
[ -t 2 ] && quiet=()
cargo build "${quiet[@]}" --release --locked --manifest-path "$root/Cargo.toml" || exit 2
