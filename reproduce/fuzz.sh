#!/usr/bin/env bash
# Fuzzing: fuzz.sh [SECONDS [TARGET ...]]. Feeds mutated files to every reader, or to those that are named, for SECONDS each (default:
# 60), and passes what they accept to the following stages, under AddressSanitizer. Ends with status 1 at the first finding, whose
# input is then in fuzz/artifacts/. Installs cargo-fuzz if it is missing. RUNS ends each target earlier, after so many inputs.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
seconds=${1:-60}
targets=("${@:2}")
[ "${#targets[@]}" -gt 0 ] || targets=(npy touch recording tables settings plot verify body bvh mesh)

"$root/reproduce/install.sh"
cargo fuzz --version >/dev/null 2>&1 || {
    echo "bodyschema: installing cargo-fuzz" >&2
    cargo install --quiet --locked cargo-fuzz
}
# Sanitizers are for nightly compilers only, unless the compiler takes itself for one.
export RUSTC_BOOTSTRAP=1
# Handing small inputs to threads takes longer than reading them.
export RAYON_NUM_THREADS=1

# In memory, where there is room: each input becomes a file.
files=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d)
trap 'rm -rf "$files"' EXIT
cd "$root"
for target in "${targets[@]}"; do
    cargo fuzz build "$target" >"$files/log" 2>&1 || {
        tail -n 40 "$files/log"
        exit 2
    }
    echo "$target, $seconds s"
    mkdir -p "fuzz/corpus/$target"
    # A world in which the physics engine failed is never freed: a leak on purpose.
    TMPDIR=$files cargo fuzz run "$target" "fuzz/corpus/$target" "fuzz/seeds/$target" -- \
        -max_total_time="$seconds" -runs="${RUNS:--1}" -timeout=20 -rss_limit_mb=1024 -max_len=2048 -detect_leaks=0 \
        -print_final_stats=1 >"$files/log" 2>&1 || {
        tail -n 40 "$files/log"
        exit 1
    }
    grep -E '^stat::(number_of_executed_units|average_exec_per_sec|slowest_unit_time_sec|peak_rss_mb)' "$files/log"
done
