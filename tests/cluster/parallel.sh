#!/usr/bin/env bash
# Usage: parallel.sh LCS SOURCE WORK
#
# Runs a suite in parts by the line of tools/cluster/README.md with GNU parallel, and kills all of it. The
# same line must go on, and the merged suite must be as the suite in one go. Exits with 77, skipped, if
# GNU parallel is not installed.
set -euo pipefail
lcs=$1 source=$2 work=$3

# shellcheck source=tests/cluster/suite.sh
. "$source/tests/cluster/suite.sh"

command -v parallel >/dev/null ||
  skip "GNU parallel is missing (Debian: parallel, which tools/test --all installs)"
rm -rf "$work"
mkdir -p "$work/bin"
ln -s "$lcs" "$work/bin/lcs"
export PATH=$work/bin:$PATH
make_whole
cd "$work"

example='--worlds train --count 1000 --jobs 4'
line=$(sed -n 's/^    parallel /parallel /p' "$source/tools/cluster/README.md")
[[ $line == *"$example"* ]] || fail "the line of the documentation is another: $line"
line=${line/"$example"/"${suite[*]} --jobs 1"}

# GNU parallel starts each part in a process group of its own, but all are in one session.
setsid bash -c "$line" >killed.log 2>&1 &
session=$!
disown
wait_for 120 "a run of part 3" has_run parts/3
while pids=$(ps --sid "$session" --format pid=); do
  # shellcheck disable=SC2086
  kill -9 $pids 2>/dev/null || true
done
[[ ! -e parts/3 ]] || fail "part 3 was finished before it was killed"
finished=$(tail -n +2 parts.log | wc -l)
echo "Killed with $finished finished parts, and $(has_run parts/3 | wc -l) finished runs of part 3"

bash -c "$line" >again.log 2>&1 || fail "the same line does not go on: $(tail again.log)"
grep 'there already' again.log || fail "part 3 began anew"
(($(grep -c '; results in ' again.log) == 4 - finished)) || fail "finished parts were repeated"
status=0
lcs merge parts/? --out merged >merge.log 2>&1 || status=$?
[[ $status == 1 ]] || fail "the merge exits with $status: $(tail merge.log)"
require_as_whole merged
