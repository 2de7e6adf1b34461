#!/usr/bin/env bash
# The multiverse that contains today's default: multiverse.toml, its surroundings (-near) and held-out movements (-held-out).
# Takes some 25 core-hours with AVX-512, and up to four times as long without, in shards of four movements. Stop it at any time, and run
# it again: what is finished is not run again, and of the rest at most one movement for each thread is lost. The shards finished so far are
# at any time an even sample of the design.
#
#   reproduce/multiverse.sh            # runs what is left
#   reproduce/multiverse.sh status     # how many shards are finished
#   reproduce/multiverse.sh save       # keeps the tables of finished shards in docs/shown/multiverse/shards, to be committed
#   reproduce/multiverse.sh restore    # takes them from there: to continue on another machine
#   reproduce/multiverse.sh gather     # tables and pictures of all finished shards; multiverse.py makes the page of them
#
# OUT is the folder of results (results/multiverse), PROGRAM the program (target/release/bodyschema; built if it is missing), and
# JOBS the number of threads (2). A shard takes half an hour to two hours on two cores.
set -euo pipefail
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
out=${OUT:-$root/results/multiverse}
program=${PROGRAM:-$root/target/release/bodyschema}
jobs=${JOBS:-2}
saved=$root/docs/shown/multiverse/shards
tables=(configurations.csv study.csv headline.csv design.toml manifest.json)

# NAME FIRST LAST of each shard, by its movements: four rounds, so that each part grows with the others.
shards() {
    for round in 0 1 2 3; do
        for shard in 0 1 2 3; do echo "multiverse $((16 * round + 4 * shard + 1)) $((16 * round + 4 * shard + 4))"; done
        for part in near held-out; do echo "multiverse-$part $((4 * round + 1)) $((4 * round + 4))"; done
    done
    echo "multiverse-held-out 17 20"
}

folder() { printf '%s/%s/movements-%02d-%02d' "$out" "$1" "$2" "$3"; }

is_finished() { [ -f "$(folder "$@")/manifest.json" ]; }

case ${1:-run} in
    run)
        mkdir -p "$out"
        exec 9>"$out/lock"
        flock -n 9 || { echo "multiverse.sh: it runs already, in $out" >&2; exit 2; }
        [ -x "$program" ] || { "$root/reproduce/build.sh" && cargo build --release --locked --manifest-path "$root/Cargo.toml"; }
        shards | while read -r name first last; do
            is_finished "$name" "$first" "$last" && continue
            echo "$(date -u +%FT%TZ) $name, movements $first to $last"
            "$program" study "$root/reproduce/$name.toml" --only "movements-$first-$last" --jobs "$jobs" \
                --out "$(folder "$name" "$first" "$last")" </dev/null
        done
        echo "$(date -u +%FT%TZ) all shards are finished"
        OUT=$out PROGRAM=$program "$root/reproduce/multiverse.sh" gather ;;
    status)
        shards | while read -r name first last; do
            at=$(folder "$name" "$first" "$last")
            if is_finished "$name" "$first" "$last"; then
                state=finished
            else
                state="$({ find "$at/checkpoints/movements" -name '*.json' 2>/dev/null || true; } | wc -l) of 80 simulations"
            fi
            echo "$name, movements $first to $last: $state"
        done ;;
    save)
        shards | while read -r name first last; do
            is_finished "$name" "$first" "$last" || continue
            to=$saved/$name/$(basename "$(folder "$name" "$first" "$last")")
            mkdir -p "$to"
            for table in "${tables[@]}"; do gzip -9n <"$(folder "$name" "$first" "$last")/$table" >"$to/$table.gz"; done
        done
        echo "$saved has the tables of $(find "$saved" -name manifest.json.gz | wc -l) of $(shards | wc -l) shards; commit it" ;;
    restore)
        (cd "$saved" && find . -name '*.gz') | while read -r file; do
            mkdir -p "$out/$(dirname "$file")"
            [ -e "$out/${file%.gz}" ] || gunzip <"$saved/$file" >"$out/${file%.gz}"
        done ;;
    gather)
        for name in multiverse multiverse-near multiverse-held-out; do
            compgen -G "$out/$name/*/manifest.json" >/dev/null || continue
            rm -rf "$out/gathered/$name"
            "$program" study "$root/reproduce/$name.toml" --join "$out/$name" --out "$out/gathered/$name"
        done ;;
    *)
        echo "multiverse.sh: $1 is not run, status, save, restore or gather" >&2
        exit 2 ;;
esac
