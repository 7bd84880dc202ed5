#!/bin/sh
# Runs the commands of docs/batch.md: GNU parallel, and a Slurm array with a dependent job that merges its shards. Starts
# Slurm's daemons for this machine in a folder of their own, compares the results with runs without shards, and stops the
# daemons. Needs the Debian packages slurm-wlm, munge and parallel, and root.
# Usage: slurm_test.sh FOLDER PROGRAM
set -eu

source=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
program=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
for tool in slurmctld slurmd sbatch munged parallel; do
  PATH="$PATH:/usr/sbin" command -v "$tool" > /dev/null || { echo "missing $tool: install slurm-wlm, munge and parallel" >&2; exit 1; }
done
PATH="$PATH:/usr/sbin"
if [ -n "$(ls -A "$folder")" ] && [ ! -e "$folder/slurm.conf" ]; then
  echo "$folder is not empty; expected an empty folder, or that of an earlier run, which is deleted" >&2
  exit 1
fi
rm -rf "$folder"/*
mkdir -p "$folder/state" "$folder/spool" "$folder/bin" "$folder/work/out"
chmod 700 "$folder"
ln -s "$program" "$folder/bin/tyndall"
export PATH="$folder/bin:$PATH" XDG_CACHE_HOME="$folder/cache" SLURM_CONF="$folder/slurm.conf"
host=$(hostname -s)

cat > "$SLURM_CONF" << EOF
ClusterName=tyndall
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
EOF

# Stops the daemons that this script has started.
stop() {
  for name in slurmd slurmctld munged; do
    [ -e "$folder/$name.pid" ] && kill "$(cat "$folder/$name.pid")" 2> /dev/null || true
  done
}
trap stop EXIT
trap 'exit 1' INT TERM

dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 2> /dev/null
chmod 400 "$folder/munge.key"
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munged.log" --seed-file="$folder/munged.seed"
slurmctld
slurmd -N "$host"
waited=0
until sinfo -h -o %T 2> /dev/null | grep -q idle; do
  waited=$((waited + 1))
  [ "$waited" -gt 60 ] && { echo "the node of Slurm is not ready:" >&2; tail -n 5 "$folder/slurmctld.log" "$folder/slurmd.log" >&2; exit 1; }
  sleep 0.5
done

cd "$folder/work"
cat > queries.csv << EOF
altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg
EOF
for i in 0 1 2 3 4 5 6; do echo "$((i * 300)),$((i * 12)),60,20" >> queries.csv; done
small="--size 64x36 --frames 6 --time-step 2 --set tables.size=4,16,12,6 --set tables.orders=1 --set sun.animate=true --set tonemap.light_adaptation=false"
probe="--queries queries.csv --model reference --samples 20000"

same() { cmp "$1" "$2" && echo "  $2 is the same"; }

echo "without shards"
# shellcheck disable=SC2086  # the options are meant to be split
tyndall render $small -o whole_%02d.exr
# shellcheck disable=SC2086
tyndall probe $probe -o whole.csv

echo "GNU parallel"
# shellcheck disable=SC2086
seq 3 | parallel --jobs 2 --halt soon,fail=1 tyndall render $small -o out/p_%02d.exr --shard {}/3 --resume
tyndall merge out/p.json out/p_%02d.exr.shard-*-of-3.json
for i in 0 1 2 3 4 5; do same "whole_0$i.exr" "out/p_0$i.exr"; done

echo "Slurm"
# shellcheck disable=SC2086
job=$(sbatch --parsable --array=1-3 "$source/examples/slurm/shard.sbatch" render $small -o out/s_%02d.exr)
merge=$(sbatch --parsable --dependency="afterok:$job" --output=merge.log \
  --wrap 'tyndall merge out/s.json out/s_%02d.exr.shard-*-of-3.json')
# shellcheck disable=SC2086
tables=$(sbatch --parsable --array=1-4 "$source/examples/slurm/shard.sbatch" probe $probe -o out/s.csv)
table=$(sbatch --parsable --dependency="afterok:$tables" --output=table.log \
  --wrap 'tyndall merge out/s.csv out/s.csv.shard-*-of-4.json')
waited=0
while squeue -h -o %i -j "$job,$merge,$tables,$table" 2> /dev/null | grep -q .; do
  waited=$((waited + 1))
  [ "$waited" -gt 600 ] && { echo "the jobs do not end:" >&2; squeue >&2; exit 1; }
  sleep 0.5
done
for state in $(scontrol -o show job | sed -n 's/.*JobState=\([A-Z]*\).*/\1/p'); do
  [ "$state" = COMPLETED ] || { echo "a job ended with $state:" >&2; cat ./*.log >&2; exit 1; }
done
echo "  $(scontrol -o show job | grep -c COMPLETED) tasks are complete"
for i in 0 1 2 3 4 5; do same "whole_0$i.exr" "out/s_0$i.exr"; done
[ -s out/s.json ]
same whole.csv out/s.csv
echo "the results with and without shards are the same"
