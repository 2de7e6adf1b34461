#!/usr/bin/env bash
# Builds article/article.pdf from the committed results: takes the numbers out of them (with --check: compares them with those
# of article/values.toml), and typesets the text. Needs Python 3.11, and a network the first time, for the compiler of typst (a
# pinned package of 34 MB, 81 MB installed). TeX would be 65 MB of packages and 207 MB installed, and another program to turn the
# pictures into PDF. The compiler is kept in target/.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

python3 "$root/article/values.py" "$@"

# A folder for each version, so that a new one is installed anew.
venv=$root/target/article-$(sha256sum "$root/article/requirements.txt" | cut -c 1-12)
if [ ! -e "$venv/done" ]; then
    python3 -c 'import ensurepip' 2>/dev/null || "$root/reproduce/install.sh" "/usr/lib/python3*/ensurepip python3-venv"
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check --require-hashes -r "$root/article/requirements.txt" || {
        echo "bodyschema: pip could not install typst (article/requirements.txt); it needs a network the first time" >&2
        exit 2
    }
    touch "$venv/done"
fi
"$venv/bin/python" "$root/article/build.py"
echo "$root/article/article.pdf"
