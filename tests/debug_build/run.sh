#!/usr/bin/env bash
# Usage: run.sh SOURCE WORK CMAKE LCS
#
# Builds SOURCE without optimisation in WORK and runs some scenarios. The output must equal that of
# LCS, the optimised program, byte for byte.
set -euo pipefail
source=$1 work=$2 cmake=$3 lcs=$4
frames=20

mkdir -p "$work"
"$cmake" -S "$source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug
"$cmake" --build "$work/build" --target lcs

status=0
for scenario in crossing suite/crossing_street suite/night_rain suite/imu_gap; do
  for program in "$lcs" "$work/build/lcs"; do
    [[ $program == "$lcs" ]] && out=$work/release || out=$work/debug
    rm -rf "$out"
    # Criteria apply to the whole run.
    "$program" run "$source/scenarios/$scenario.yaml" --set frames=$frames --set 'criteria=[]' \
      --no-video --quiet --out "$out"
  done
  for file in layers.jsonl truth.jsonl; do
    [[ $(wc -l <"$work/release/$file") -ge $frames ]] || {
      printf 'FAILED: %s of %s is too short\n' "$file" "$scenario"
      status=1
    }
    cmp "$work/release/$file" "$work/debug/$file" || {
      printf 'FAILED: %s of %s depends on the type of the build\n' "$file" "$scenario"
      status=1
    }
  done
done
exit "$status"
