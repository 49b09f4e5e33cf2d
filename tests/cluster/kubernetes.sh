#!/usr/bin/env bash
# Usage: kubernetes.sh LCS SOURCE WORK
#
# Validates tools/cluster/kubernetes.yaml by the schemas of Kubernetes, and runs the commands of its
# containers without Kubernetes. The merged suite must be as the suite in one go. Exits with 77,
# skipped, if the validator cannot be downloaded.
set -euo pipefail
lcs=$1 source=$2 work=$3
jobs=$source/tools/cluster/kubernetes.yaml

# shellcheck source=tests/cluster/suite.sh
. "$source/tests/cluster/suite.sh"

rm -rf "$work"
mkdir -p "$work/bin"
install "$work" kubernetes-validate
validate() { "$work/venv/bin/kubernetes-validate" --strict "$@"; }
validate "$jobs" || fail "the jobs are not valid"
validate --kubernetes-version 1.33 "$jobs" || fail "the jobs are not valid in the oldest version that they name"
sed 's/completions:/completion:/' "$jobs" >"$work/wrong.yaml"
validate --quiet "$work/wrong.yaml" && fail "the validator accepts a wrong key"

make_whole
ln -s "$lcs" "$work/bin/lcs"
cd "$work"
# run_container JOB ARGUMENT... runs the command of a job's container with other arguments.
run_container() {
  mapfile -d '' command < <("$work/venv/bin/python" -c '
import sys, yaml
job, = (job for job in yaml.safe_load_all(open(sys.argv[1])) if job["metadata"]["name"] == sys.argv[2])
container = job["spec"]["template"]["spec"]["containers"][0]
for word in container["command"]:
    print(word, end="\0")' "$jobs" "$1")
  env PATH="$work/bin:$PATH" "${command[@]}" "${@:2}"
}
export JOBS=2 PARTS=4 JOB_COMPLETION_INDEX
for JOB_COMPLETION_INDEX in 0 1 2 3; do
  run_container lcs-parts "${suite[@]}" >"part.log" 2>&1 || fail "a part exits with $?: $(tail part.log)"
done
status=0
run_container lcs-merge --worst-first >merge.log 2>&1 || status=$?
[[ $status == 1 ]] || fail "the merge exits with $status: $(tail merge.log)"
require_as_whole suite
