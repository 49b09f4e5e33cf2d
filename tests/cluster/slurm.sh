#!/usr/bin/env bash
# Usage: slurm.sh LCS SOURCE WORK
#
# Starts Slurm with two nodes on this machine, submits a suite by tools/cluster/slurm.sh, and kills a
# node with its part. The part must go on when the node is back, and the merged suite must be as the
# suite in one go. Exits with 77, skipped, if Slurm cannot run here.
set -euo pipefail
lcs=$1 source=$2 work=$3

# shellcheck source=tests/cluster/suite.sh
. "$source/tests/cluster/suite.sh"

mkdir -p "$work"
for dir in . .. / // ./ a/.. a/../ 'o%A' 'o\a'; do
  (cd "$work" && "$source/tools/cluster/slurm.sh" 2 "$dir" -- true suite) >"$work/refusal.log" 2>&1 && fail "DIR $dir is accepted"
  grep -q "DIR must" "$work/refusal.log" || fail "DIR $dir is refused by: $(cat "$work/refusal.log")"
done
for command in munged slurmctld slurmd sbatch; do
  PATH=$PATH:/usr/sbin command -v $command >/dev/null ||
    skip "$command is missing (Debian: munge slurmctld slurmd slurm-client, which tools/test --all installs)"
done
[[ $EUID -eq 0 ]] || skip "only root can start nodes"
unshare --pid --fork --mount-proc true 2>/dev/null || skip "this machine allows no process namespaces"

rm -rf "$work"
mkdir -p "$work"
make_whole

# The state is in a short path, as that of a socket is limited.
state=$(mktemp -d /tmp/lcs-slurm.XXXXXX)
declare -A node
submitted=
end_daemons() {
  local file pid
  [[ -z $submitted ]] || kill "$submitted" 2>/dev/null || true
  for pid in "${node[@]}"; do kill -9 "$pid" 2>/dev/null || true; done
  for file in "$state"/{slurmctld,munged}.pid; do
    if pid=$(cat "$file" 2>/dev/null) && kill "$pid"; then tail --pid="$pid" -f /dev/null; fi
  done
  cp "$state"/*.log "$work" 2>/dev/null || true
  rm -rf "$state"
}
trap end_daemons EXIT

chmod 711 "$state"
mkdir "$state/state" "$state/n1" "$state/n2"
head -c 128 /dev/urandom >"$state/key"
chmod 600 "$state/key"
export PATH=$PATH:/usr/sbin SLURM_CONF=$state/slurm.conf
host=$(hostname -s)
cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17000
SlurmUser=root
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$state/munge.socket,cred_expire=5
StateSaveLocation=$state/state
SlurmdSpoolDir=$state/%n
SlurmctldPidFile=$state/slurmctld.pid
SlurmdPidFile=$state/%n.pid
SlurmctldLogFile=$state/slurmctld.log
SlurmdLogFile=$state/%n.log
SlurmdTimeout=10
SchedulerParameters=bf_interval=2,sched_interval=2
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17001 CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17002 CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES
END
munged --force --key-file="$state/key" --socket="$state/munge.socket" --pid-file="$state/munged.pid" \
  --log-file="$state/munged.log" --seed-file="$state/seed"
slurmctld -f "$SLURM_CONF"

# A node is a process namespace: all its processes die with its first, as when a machine fails.
start_node() {
  # shellcheck disable=SC2016
  unshare --pid --fork --mount-proc --kill-child bash -c 'slurmd -D -N "$0" & wait' "$1" \
    >>"$work/$1.out" 2>&1 &
  node[$1]=$!
  disown
}
start_node n1
start_node n2
is_ready() { [[ $(sinfo --noheader --format=%D --states=idle) == 2 ]]; }
wait_for 60 "two idle nodes" is_ready

cd "$work"
# This ends before the test's limit of time, which would leave the daemons.
submit=(timeout 240 "$source/tools/cluster/slurm.sh" 4 merged --wait)
command=("$lcs" suite "${suite[@]}" --baseline whole --fail-on-regression)
for wrong in "--jobs 3" --anew --list "--baseline nowhere" "--seeds none"; do
  # shellcheck disable=SC2086
  "${submit[@]}" -- "${command[@]}" $wrong >refusal.log 2>&1 && fail "slurm.sh accepts $wrong"
done
"$source/tools/cluster/slurm.sh" 15 merged -- "${command[@]}" 2>refusal.log && fail "15 parts of 14 runs are accepted"
grep 'make fewer parts' refusal.log || fail "too many parts are refused by: $(cat refusal.log)"
[[ ! -e merged.parts && -z $(squeue --noheader) ]] || fail "something refused was submitted"

"${submit[@]}" -- "${command[@]}" &
submitted=$!
wait_for 120 "a run of part 2" has_run merged.parts/2
name=$(squeue --noheader --name=lcs-suite --array --format='%K %N' | sed -n 's/^2 //p')
echo "Part 2 runs on $name, which is killed with $(has_run merged.parts/2 | wc -l) finished runs"
kill -9 "${node[$name]}"
[[ ! -e merged.parts/2 ]] || fail "part 2 was finished before its node was killed"
is_down() { scontrol show node "$name" | grep State=DOWN; }
wait_for 60 "Slurm to see that $name is down" is_down
start_node "$name"

require_merged() {
  [[ $1 == 1 ]] || fail "the merge exits with $1: $(tail merged.parts/merge.log)"
  grep '^equal' merged.parts/merge.log || fail "the merge does not compare with the baseline"
  require_as_whole merged
}
status=0
wait $submitted || status=$?
submitted=
grep 'requeue job' "$state/slurmctld.log" || fail "Slurm has not started part 2 again"
grep 'there already' merged.parts/2.log || fail "part 2 began anew"
require_merged $status

echo "Part 3 is lost, and submitted alone"
rm -r merged merged.parts/3 merged.parts/merge.log
status=0
"${submit[@]}" --array=3 -- "${command[@]}" || status=$?
require_merged $status
