#!/usr/bin/env bash
# Checks this repository as a stranger would: clones what is committed into a folder (--into FOLDER, by default a new one under
# /tmp), reruns both experiments, the multiverse and the article, and compares with the committed results. Tolerances and minutes
# are in codecheck.toml. --only NAMES checks some parts (such as --only exp1,article), and is the only way to the registered
# confirmation (--only confirm). In a folder that has the clone already, it goes on. Status: 0 all agrees, 1 something does not,
# 2 on an error.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

into=
arguments=()
while [ $# -gt 0 ]; do
    case $1 in
    --into)
        [ $# -ge 2 ] || { echo "codecheck: --into needs a folder" >&2; exit 2; }
        into=$2
        shift
        ;;
    *) arguments+=("$1") ;;
    esac
    shift
done
[ -n "$into" ] || into=$(mktemp -d)

revision=$(git -C "$root" rev-parse HEAD)
if [ -e "$into/.git" ]; then
    [ "$(git -C "$into" rev-parse HEAD)" = "$revision" ] || {
        echo "codecheck: $into has another revision; give a new folder" >&2
        exit 2
    }
else
    git clone --quiet "$root" "$into"
    git -C "$into" checkout --quiet --detach "$revision"
fi
echo "checking revision ${revision:0:7} in $into"
exec python3 "$into/reproduce/codecheck.py" "${arguments[@]}"
