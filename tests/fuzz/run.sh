#!/usr/bin/env bash
# Usage: run.sh SOURCE BUILD CMAKE [SECONDS [FUZZER]...]
#
# Builds the fuzzers with clang and runs each for SECONDS (20) from the stored inputs. Exits with 1
# if one finds a crash, a hang or growing memory, and leaves the input in BUILD/found; with 77,
# skipped, without a clang that has libFuzzer.
set -euo pipefail
source=$1 build=$2 cmake=$3 seconds=${4:-20}
shift $(($# < 4 ? $# : 4))
fuzzers=("$@")
[[ ${#fuzzers[@]} -gt 0 ]] ||
  fuzzers=(scenario parameters detections labels recording run_folder scene ego_motion filter)
here=$source/tests/fuzz

if ! echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
  clang++-14 -x c++ -fsanitize=fuzzer,address,undefined -o /dev/null - 2>/dev/null; then
  echo 'SKIPPED: there is no clang 14 with libFuzzer (Debian: clang-14 libclang-rt-14-dev, which' \
    'tools/test --all installs)'
  exit 77
fi

(cd "$source" && "$cmake" --preset fuzz -B "$build" >/dev/null)
"$cmake" --build "$build" --target lcs_fuzzers

mkdir -p "$build/found"
status=0
for name in "${fuzzers[@]}"; do
  # New inputs go to the first folder and remain there for the next run.
  grown=$build/grown/$name
  mkdir -p "$grown"
  inputs=("$grown" "$here/corpus/$name")
  [[ $name == scenario ]] && inputs+=("$source/scenarios/suite")
  memory_mb=2048
  [[ $name == scene ]] && memory_mb=6000 # of textures that are just not too large
  log=$build/found/$name.log
  if "$build/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -max_len=20000 -timeout=60 \
    -rss_limit_mb="$memory_mb" -artifact_prefix="$build/found/$name-" "${inputs[@]}" >"$log" 2>&1; then
    printf '%s: %s\n' "$name" "$(grep -E '^Done ' "$log")"
  else
    printf '%s: FAILED, see %s\n' "$name" "$log"
    grep -E 'ERROR|runtime error|does not hold|SUMMARY|Test unit written' "$log" || true
    status=1
  fi
done
exit "$status"
