#!/usr/bin/env bash
# Submits a study, or the study of bodies, to Slurm: a job array with a shard for each task, and a job that gathers them. All tasks write into
# one folder, which all nodes must see. Submit again what failed: finished movements are not run again.
set -euo pipefail
here=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(CDPATH= cd -- "$here/../.." && pwd)

usage() {
    cat <<EOF
Usage: reproduce/cluster/submit.sh --shards N --out DIR [--bodies] [--design FILE] [--program FILE] [-- SBATCH OPTIONS]

  --shards N      tasks of the job array; at most as many as the study has movements
  --out DIR       folder that all nodes see
  --bodies        a study of bodies (bodyschema bodies) instead of another one (bodyschema study)
  --design FILE   design, instead of reproduce/multiverse.toml or, with --bodies, reproduce/bodies.toml
  --program FILE  bodyschema, instead of target/release/bodyschema; a command line in a container works, too:
                  --program 'apptainer exec bodyschema.sif bodyschema'
  -- OPTIONS      for sbatch, such as --partition, --account or --time, for both jobs

Each task asks for 2 CPUs, 4 GB and 12 hours unless OPTIONS say otherwise.
EOF
}

shards='' out='' subcommand=study design='' program=$root/target/release/bodyschema
while [ $# -gt 0 ]; do
    case $1 in
        --shards | --out | --design | --program)
            [ $# -ge 2 ] || { echo "submit.sh: $1 needs a value" >&2; exit 2; }
            declare "${1#--}=$2"
            shift 2 ;;
        --bodies) subcommand=bodies; shift ;;
        --) shift; break ;;
        -h | --help) usage; exit 0 ;;
        *) echo "submit.sh: $1 is not an option; see --help" >&2; exit 2 ;;
    esac
done
case $subcommand in bodies) default=bodies ;; *) default=multiverse ;; esac
design=${design:-$root/reproduce/$default.toml}
[[ $shards =~ ^[1-9][0-9]*$ ]] || { echo "submit.sh: --shards must be a positive number; see --help" >&2; exit 2; }
[ -n "$out" ] || { echo "submit.sh: --out is missing; see --help" >&2; exit 2; }
[ -r "$design" ] || { echo "submit.sh: $design: cannot be read; give a design with --design" >&2; exit 2; }
command -v sbatch >/dev/null || { echo "submit.sh: there is no sbatch here; log in to a node that submits jobs" >&2; exit 2; }

mkdir -p -- "$out/logs"
out=$(readlink -f -- "$out")
export BODYSCHEMA=$program SUBCOMMAND=$subcommand DESIGN=$(readlink -f -- "$design") OUT=$out SHARDS=$shards
common=(--parsable --export=ALL --time=12:00:00 --mem=4G)
array=$(sbatch "${common[@]}" --cpus-per-task=2 --array="0-$((shards - 1))" --output="$out/logs/shard-%a.log" "$@" \
    "$here/shard.sbatch")
gather=$(sbatch "${common[@]}" --cpus-per-task=2 --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --output="$out/logs/gather.log" \
    "$@" "$here/gather.sbatch")
echo "shards: job ${array%%;*}; gather: job ${gather%%;*}"
