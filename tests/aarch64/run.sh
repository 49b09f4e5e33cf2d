#!/usr/bin/env bash
# Usage: run.sh SOURCE BUILD
#
# Builds the filter and its tests for aarch64, whose vector instructions are NEON, and runs them by
# qemu. Compares the filter's layers with those of this machine bit by bit. Exits with 77, skipped,
# without the cross compiler, qemu or the sources of GoogleTest.
set -euo pipefail
source=$1 build=$2
compiler=aarch64-linux-gnu-g++ googletest=/usr/src/googletest/googletest

if ! command -v $compiler >/dev/null || ! command -v qemu-aarch64 >/dev/null ||
  [[ ! -e $googletest/src/gtest-all.cc ]]; then
  echo 'SKIPPED: there is no cross compiler for aarch64, no qemu-aarch64 or no source of GoogleTest' \
    '(Debian: g++-aarch64-linux-gnu qemu-user googletest, which tools/test --all installs)'
  exit 77
fi

mkdir -p "$build"
cd "$source"
options=(-std=c++20 -O2 -ffp-contract=off -Wno-psabi -I. -isystem /usr/include/eigen3)
mapfile -t filter < <(
  find filter -name '*.cpp' ! -name '*avx2.cpp' ! -path 'filter/detect/*' | sort)
mapfile -t tests < <(sed -n '/^add_executable(filter_tests/,/^)/s|^  \(.*\.cpp\)$|tests/filter/\1|p' \
  tests/filter/CMakeLists.txt)

# compile COMPILER FOLDER OPTION... -- FILE...: objects of the files, two at a time
compile() {
  local with=$1 folder=$2 more=()
  shift 2
  while [[ $1 != -- ]]; do more+=("$1") && shift; done
  shift
  mkdir -p "$folder"
  printf '%s\n' "$@" | xargs -P 2 -I{} sh -c '
    file=$1; shift
    "$@" -c "$file" -o "'"$folder"'/$(echo "$file" | tr / _).o"' _ {} "$with" "${options[@]}" "${more[@]}"
}

compile $compiler "$build/aarch64" -- "${filter[@]}" tests/aarch64/same_bits.cpp
compile g++ "$build/native" -- "${filter[@]}" tests/aarch64/same_bits.cpp
compile $compiler "$build/tests" -isystem $googletest/include -I$googletest \
  -DLCS_FILTER_SOURCE_DIR="\"$source/filter\"" -- \
  "${tests[@]}" $googletest/src/gtest-all.cc $googletest/src/gtest_main.cc

g++ -o "$build/same_bits" "$build"/native/*.o
$compiler -static -o "$build/same_bits_aarch64" "$build"/aarch64/*.o
$compiler -static -o "$build/filter_tests_aarch64" "$build"/tests/*.o \
  $(printf '%s\n' "$build"/aarch64/*.o | grep -v same_bits)

"$build/same_bits" make "$build/frames.txt"
"$build/same_bits" run "$build/frames.txt" >"$build/native.txt"
qemu-aarch64 "$build/same_bits_aarch64" run "$build/frames.txt" >"$build/aarch64.txt"
cmp "$build/native.txt" "$build/aarch64.txt"
echo "the layers have the same bits: $(grep -c ^edge "$build/native.txt") edges"

qemu-aarch64 "$build/filter_tests_aarch64" --gtest_brief=1
