#!/usr/bin/env bash
# Usage: run.sh SOURCE WORK CMAKE MAJOR WHEEL
#
# Downloads the newest WHEEL of MuJoCo MAJOR (it has the headers and the library), builds SOURCE
# with it in WORK, and runs a few frames. Exits with 77, skipped, if the download fails.
set -euo pipefail
source=$1 work=$2 cmake=$3 major=$4 wheel=$5
frames=5

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

build() {
  "$cmake" -S "$source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DLCS_MUJOCO_ROOT="$work/mujoco"
  "$cmake" --build "$work/build" --target lcs
}

run() {
  "$work/build/lcs" --version | tee "$work/version.txt"
  grep -qE "MuJoCo +$major\." "$work/version.txt" || fail "the program does not run on MuJoCo $major"
  rm -rf "$work/out"
  "$work/build/lcs" run "$source/scenarios/crossing.yaml" --set frames="$frames" --out "$work/out"
  local file
  for file in metrics.json frames.csv layers.jsonl video.mp4; do
    [[ -s $work/out/$file ]] || fail "the run left no $file"
  done
  grep -qE "\"frames\": *$frames(\.0)?[,}]?$" "$work/out/metrics.json" ||
    fail "metrics.json does not tell of $frames frames"
  [[ $(wc -l <"$work/out/frames.csv") -eq $((frames + 1)) ]] ||
    fail "frames.csv does not have a header and $frames rows"
}

mkdir -p "$work"
rm -rf "$work/unpacked" "$work/mujoco"
download "$wheel" "$work" "$work/pip.log" ||
  skip "the Python package registry is not reachable, so there is no MuJoCo $major to build against"
mv "$work/unpacked/mujoco" "$work/mujoco"
build
run
