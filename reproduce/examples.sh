#!/usr/bin/env bash
# Executes the examples of the Python package, and compares their pages (docs/shown/examples, and the notebook in python/examples) with the
# committed ones. With --write it writes them instead. Builds the package in an environment of its own in target/ first. Needs Python 3.11
# with venv, Rust, and a network for pip the first time. Takes about two minutes once built, on two cores. Status: 0 the same or written,
# 1 an example fails or its page is another one, 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

case "$*" in
"" | --check | --write) ;;
*)
    echo "usage: reproduce/examples.sh [--check | --write]" >&2
    exit 2
    ;;
esac

"$root/reproduce/install.sh" || exit 2
python3 -c "import ensurepip" 2>/dev/null || "$root/reproduce/install.sh" "/usr/lib/python3*/ensurepip python3-venv" || exit 2
venv=$root/target/examples-$(sha256sum "$root/python/requirements.txt" | cut -c 1-12)
{
    [ -e "$venv/done" ] || {
        rm -rf "$venv"
        python3 -m venv "$venv"
        "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$root/python/requirements.txt"
        touch "$venv/done"
    }
    PATH=$venv/bin:$PATH "$venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --no-build-isolation --force-reinstall "$root"
} || exit 2
"$venv/bin/python" "$root/reproduce/examples.py" "$@"
