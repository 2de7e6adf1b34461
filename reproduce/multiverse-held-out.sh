#!/usr/bin/env bash
# A smaller multiverse of another seed, by the same design: 104 specifications of 13 movements. It should reproduce each claim in
# about the same share of specifications as the large one: reproduce/docs.py compares both. Writes
# results/multiverse-held-out.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

design=$(mktemp --suffix .toml)
trap 'rm -f "$design"' EXIT
# The movements have the seeds from 6500001 on.
sed -e 's/^seed = .*/seed = 6500000/' -e 's/^movements = .*/movements = 13/' -e 's/^inferences = .*/inferences = 2/' \
    "$root/reproduce/multiverse.toml" > "$design"
"$root/reproduce/run.sh" multiverse-held-out multiverse --design "$design" "$@"
