#!/usr/bin/env bash
# Whether the job array does what it should: starts a Slurm of one node on this machine, submits a small study as an
# array, kills and requeues a task, and compares the gathered bytes with those of a run without Slurm. Then the same, without a
# kill, with a small study of bodies. Needs root, and Debian or Ubuntu; installs slurm-wlm and munge. Takes some three minutes.
set -euo pipefail
here=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(CDPATH= cd -- "$here/../.." && pwd)
program=${BODYSCHEMA:-$root/target/release/bodyschema}

[ "$(id -u)" = 0 ] || { echo "test.sh: starting a Slurm needs root; run it in a container or a virtual machine" >&2; exit 2; }
if ! command -v slurmctld >/dev/null || ! command -v munged >/dev/null; then
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq slurm-wlm munge >/dev/null
fi
if [ ! -x "$program" ]; then
    "$root/reproduce/install.sh"
    cargo build --release --locked --quiet --manifest-path "$root/Cargo.toml"
fi

work=$(mktemp -d)
stop() {
    status=$?
    for pid in slurmd slurmctld munged; do
        [ ! -s "$work/$pid.pid" ] || kill "$(cat "$work/$pid.pid")" 2>/dev/null || true
    done
    # Until they have written their last files.
    for _ in $(seq 50); do pgrep -f "$work" >/dev/null || break; sleep 0.1; done
    [ $status = 0 ] || tail -n 5 "$work"/*.log "$work"/slurm*/logs/*.log >&2 2>/dev/null || true
    rm -rf "$work"
    exit $status
}
trap stop EXIT

# munge, with a key and folders of its own.
install -d -o munge -g munge -m 755 "$work/munge"
chmod 755 "$work"
dd if=/dev/urandom of="$work/munge/key" bs=64 count=1 status=none
chown munge:munge "$work/munge/key"
chmod 400 "$work/munge/key"
touch "$work/munged.pid"
chown munge:munge "$work/munged.pid"
runuser -u munge -- munged --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munged.pid" \
    --seed-file="$work/munge/seed" --log-file="$work/munge/log" --force

mkdir -p "$work/state" "$work/spool"
cat >"$work/slurm.conf" <<EOF
ClusterName=one
SlurmctldHost=$(hostname -s)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobRequeue=1
RequeueExit=75
MpiDefault=none
NodeName=$(hostname -s) CPUs=$(nproc) RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
export SLURM_CONF=$work/slurm.conf
slurmctld -f "$SLURM_CONF"
slurmd -f "$SLURM_CONF"
for _ in $(seq 60); do
    [ "$(sinfo -h -o %T 2>/dev/null)" != idle ] || break
    sleep 1
done
sinfo

design=$here/small.toml
"$program" study "$design" --out "$work/alone"

"$here/submit.sh" --shards 4 --design "$design" --program "$program" --out "$work/slurm" -- --cpus-per-task=1 --mem=500M
array=$(squeue -h -r -n study -o %F | head -n 1)
# Killed in the middle of its work, and requeued.
for _ in $(seq 60); do
    [ ! -d "$work/slurm/checkpoints" ] || break
    sleep 0.2
done
requeued=$(squeue -h -r -t RUNNING -n study -o %i | head -n 1)
[ -n "$requeued" ] && scontrol requeue "$requeued" && echo "killed and requeued $requeued"
wait_for_all() {
    for _ in $(seq 300); do
        [ -n "$(squeue -h)" ] || break
        sleep 1
    done
}
wait_for_all
[ -f "$work/slurm/study.md" ] || { echo "test.sh: the shards of job $array were not gathered" >&2; exit 1; }
[ -n "$requeued" ] || { echo "test.sh: no task was running, so none was killed" >&2; exit 1; }
diff -r --exclude=checkpoints --exclude=logs --exclude=ro-crate-metadata.json "$work/alone" "$work/slurm"
echo "a run under Slurm, with a task killed and requeued, gave the same bytes as one without"

design=$here/small-bodies.toml
"$program" bodies --design "$design" --out "$work/bodies"
"$here/submit.sh" --shards 2 --bodies --design "$design" --program "$program" --out "$work/slurm-bodies" -- --cpus-per-task=1 --mem=500M
wait_for_all
[ "$(grep -l "This shard is finished" "$work"/slurm-bodies/logs/shard-*.log | wc -l)" = 2 ]
grep -q "continuing from what an earlier run finished" "$work/slurm-bodies/logs/gather.log"
diff -r --exclude=checkpoints --exclude=logs --exclude=ro-crate-metadata.json "$work/bodies" "$work/slurm-bodies"
echo "so did a study of bodies"
