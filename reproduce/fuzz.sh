#!/usr/bin/env bash
# Fuzzing: fuzz.sh [SECONDS]. Feeds mutated files to every reader for SECONDS each (default: 60), and passes what they accept to
# the following stages, under AddressSanitizer. Needs a nightly compiler and cargo-fuzz, and installs them if they are
# missing. Ends with status 1 at the first finding, whose input is then in fuzz/artifacts/.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
seconds=${1:-60}

"$root/reproduce/install.sh"
rustup toolchain list | grep -q '^nightly' || {
    echo "bodyschema: installing the nightly compiler" >&2
    rustup toolchain install nightly --profile minimal
}
cargo fuzz --version >/dev/null 2>&1 || {
    echo "bodyschema: installing cargo-fuzz" >&2
    cargo install --quiet --locked cargo-fuzz
}

files=$(mktemp -d)
trap 'rm -rf "$files"' EXIT
cd "$root"
cargo +nightly fuzz build >"$files/log" 2>&1 || {
    tail -n 40 "$files/log"
    exit 2
}
for target in npy touch tables settings plot verify body bvh mesh; do
    echo "$target, $seconds s"
    mkdir -p "fuzz/corpus/$target"
    # A world in which the physics engine failed is never freed: a leak on purpose.
    TMPDIR=$files cargo +nightly fuzz run "$target" "fuzz/corpus/$target" "fuzz/seeds/$target" -- \
        -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=2048 -detect_leaks=0 -print_final_stats=1 \
        >"$files/log" 2>&1 || {
        tail -n 40 "$files/log"
        exit 1
    }
    grep -E '^stat::(number_of_executed_units|average_exec_per_sec|slowest_unit_time_sec|peak_rss_mb)' "$files/log"
done
