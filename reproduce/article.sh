#!/usr/bin/env bash
# Builds the article from the committed results, and compares it with the committed one: its numbers (article/values.toml, the
# abstracts of article/metadata.yaml and CITATION.cff), and article/article.pdf byte by byte. With --write it writes them all
# instead. Status: 0 they are the same, 1 they are not, 2 on an error. Needs Python 3.11, and a network the first time, for the
# compiler of typst (a pinned package of 34 MB, 81 MB installed, with its fonts). The compiler is kept in target/.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

case "$*" in
--write) values=() build=(--write) ;;
"" | --check) values=(--check) build=() ;;
*)
    echo "usage: reproduce/article.sh [--check | --write]" >&2
    exit 2
    ;;
esac

python3 -c 'import tomllib' 2>/dev/null || { echo "article: needs Python 3.11 or newer" >&2; exit 2; }
python3 "$root/article/values.py" "${values[@]}"

# A folder for each version, so that a new one is installed anew.
venv=$root/target/article-$(sha256sum "$root/article/requirements.txt" | cut -c 1-12)
if [ ! -e "$venv/done" ]; then
    python3 -c 'import ensurepip' 2>/dev/null || "$root/reproduce/install.sh" "/usr/lib/python3*/ensurepip python3-venv"
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check --require-hashes -r "$root/article/requirements.txt" || {
        echo "article: pip could not install typst (article/requirements.txt); it needs a network the first time" >&2
        exit 2
    }
    touch "$venv/done"
fi
"$venv/bin/python" "$root/article/build.py" "${build[@]}"
echo "$root/article/article.pdf"
