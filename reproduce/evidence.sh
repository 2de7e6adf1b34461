#!/usr/bin/env bash
# Evidence that is too slow for the tests: recovery of trees drawn from the model, and line coverage. Writes tests/evidence/.
# Takes about five minutes on two cores, and more if it must first install cargo-tarpaulin.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
out=$root/tests/evidence

"$root/reproduce/install.sh"
mkdir -p "$out"
cargo run --quiet --release --locked --manifest-path "$root/Cargo.toml" --example recovery "$out"

# cargo-llvm-cov needs a rustup component; tarpaulin reads the compiler's counters by itself. Dead code stays out
# because pulp, which faer brings, does not compile with it.
cargo tarpaulin --version >/dev/null 2>&1 || cargo install --quiet --locked cargo-tarpaulin
cargo tarpaulin --engine llvm --no-dead-code --timeout 1800 --locked --manifest-path "$root/Cargo.toml" --target-dir "$root/target/coverage" \
    --include-files 'src/*' --skip-clean --out Json --output-dir "$root/target/coverage" >/dev/null
"$root/reproduce/coverage.py" "$root" "$root/target/coverage/tarpaulin-report.json" >"$out/coverage.md"
cat "$out/coverage.md"
