#!/usr/bin/env bash
# Usage: run.sh SOURCE BUILD WORK CMAKE findpackage|addsubdirectory|program
#
# Uses the project from outside: by find_package from a folder where BUILD was installed and then
# moved, or as a subdirectory of another project; or runs the installed program.
set -euo pipefail
source=$1 build=$2 work=$3/$5 cmake=$4
project=$source/tests/outside/project

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

# Moves the installation, so that the original folder no longer exists.
install() {
  "$cmake" --install "$build" --prefix "$work/first" "$@" >"$work/install.log"
  mv "$work/first" "$work/prefix"
}

build() {
  "$cmake" -S "$project" -B "$work/build" -G Ninja "$@"
  "$cmake" --build "$work/build" --target step detect
  "$work/build/step"
  "$work/build/detect"
}

rm -rf "$work"
mkdir -p "$work"
cd "$work"
case $5 in
  findpackage)
    install --component filter
    build -DCMAKE_PREFIX_PATH="$work/prefix"
    grep -q "^lcs_DIR:PATH=$work/prefix/" build/CMakeCache.txt || fail "another package was found"
    ;;
  addsubdirectory)
    build -DLCS_SOURCE="$source"
    [[ $("$cmake" --build build --target help) != *_test* ]] || fail "there are tests in it"
    ;;
  program)
    install
    [[ ! -e prefix/lcs ]] || fail "the Python package is installed with the program"
    lcs=$work/prefix/bin/lcs
    "$lcs" run prefix/share/lcs/scenarios/crossing.yaml --set frames=3 --out out
    [[ -s out/metrics.json && -s out/video.mp4 ]] || fail "the run left no metrics.json or no video.mp4"
    cp prefix/share/lcs/scenarios/{crossing,of_the_installed}.yaml
    "$lcs" suite --group all --list >list.txt
    grep -q '^of_the_installed ' list.txt || fail "its suite is not of the scenarios installed"
    # Detects a program that loads its codecs from BUILD.
    find prefix -name 'liblcs_media.so' -delete
    ! "$lcs" run prefix/share/lcs/scenarios/crossing.yaml --set frames=3 --out none 2>error.txt ||
      fail "the run does without the codecs that were installed"
    grep -q 'cannot load liblcs_media.so' error.txt || fail "something else is missing: $(cat error.txt)"
    # Detects a program that reads its scene from SOURCE.
    rm -r prefix/share/lcs/scenes/ego
    ! "$lcs" run prefix/share/lcs/scenarios/crossing.yaml --no-video --out none 2>error.txt ||
      fail "the run does without the rover that was installed"
    grep -q "prefix/share/lcs/scenes/ego" error.txt || fail "something else is missing: $(cat error.txt)"
    # Detects a program that loads MuJoCo from SOURCE.
    find prefix -name 'libmujoco.so*' -delete
    [[ ! -e $source/.mujoco ]] || ! "$lcs" --version >none.txt 2>&1 ||
      fail "the program does without the MuJoCo that was installed"
    ;;
esac
