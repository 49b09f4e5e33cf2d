#!/usr/bin/env bash
# Usage: run.sh SOURCE BUILD WORK [PACKAGES]
#
# Makes the packages by tools/package/build, or takes those in PACKAGES, and runs the program in copies
# of a fresh Debian 12 without the sources: one where the Containerfile's commands installed the .deb,
# one that has nothing but the unpacked archive, and one where pip installed the wheel. The archive also
# runs in Debian 13 and Ubuntu 24.04, if they can be had. The results must be those of BUILD. Exits with
# 77, skipped, if this is not possible.
set -euo pipefail
source=$1 build=$2 work=$3 packages=${4-}

# shellcheck source=tests/systems/root.sh
. "$source/tests/systems/root.sh"

# shellcheck source=/dev/null
. /etc/os-release
[[ $ID$VERSION_ID == debian12 ]] || skip "a package made on $PRETTY_NAME needs the libraries of that"
[[ $build == "$source/build" ]] || skip "tools/package/build packs build/, not $build"

# Without times, which differ from run to run.
without_times() {
  sed '/"time\./d; /"sim.frames_per_second"/d' "$1"
}

# try NAME PREFIX: runs the program of PREFIX in the copy NAME
try() {
  local root=$work/$1 prefix=$2
  # shellcheck disable=SC2016  # the system's shell expands these
  in_system "$root" sh -euc '
    PATH=$0/bin:$PATH
    shipped=$0/share/lcs/scenarios
    few="--set frames=5 --set criteria=[] --quiet"
    cd /home
    lcs --version
    lcs --help >help.txt
    lcs run "$shipped/crossing.yaml" --quiet --out run
    lcs suite --filter "^crossing_(near|street)$" --seeds 1 $few --out suite
    lcs world room --quiet --out world
    lcs run world/room_1.yaml $few --out room
    lcs generate "$shipped/crossing.yaml" --formats euroc --frames 5 --quiet --out drive
    lcs replay drive --quiet --out replay' "$prefix" || fail "the program of $1 does not run"
  without_times "$root/home/run/metrics.json" | cmp - "$work/metrics.json" ||
    fail "the metrics of $1 are not those of the build"
  cmp "$root/home/run/layers.jsonl" "$work/run/layers.jsonl" ||
    fail "the layers of $1 are not those of the build"
}

# Nothing is mounted in the copies any more: in_system ends its mounts.
remove_copies() {
  rm -rf --one-file-system "$work"/{deb,archive,wheel,made}
}
trap remove_copies EXIT

install_system bookworm "$work/bookworm"
remove_copies
if [[ -z $packages ]]; then
  packages=$work/made
  CI=1 "$source/tools/package/build" --out "$packages"
fi
"$build/lcs" run "$source/scenarios/crossing.yaml" --quiet --out "$work/run"
without_times "$work/run/metrics.json" >"$work/metrics.json"

for suite in bookworm trixie noble; do
  status=0
  (install_system "$suite" "$work/$suite") || status=$?
  ((status != 77)) || continue  # it has said why
  ((status == 0)) || fail "$suite cannot be installed"
  rm -rf --one-file-system "$work/archive"
  cp -a "$work/$suite" "$work/archive"
  mkdir "$work/archive/opt/lcs"
  tar -C "$work/archive/opt/lcs" --strip-components=1 -xf "$packages"/lcs-*.tar.gz
  try archive /opt/lcs
done

cp -a "$work/bookworm" "$work/deb"
cp "$packages"/lcs_*.deb "$work/deb/tmp"
in_system "$work/deb" sh -euc "$(sed -n 's/^RUN //p' "$packages/Containerfile")" \
  >"$work/install.log" 2>&1 || fail "the .deb cannot be installed: $(tail "$work/install.log")"
try deb /usr

# Detects a program that does not find its reader of bags.
in_system "$work/deb" sh -euc '
  apt-get update
  apt-get install -y --no-install-recommends python3' >"$work/python.log" 2>&1 ||
  fail "python3 cannot be installed: $(tail "$work/python.log")"
touch "$work/deb/home/empty.bag"
! in_system "$work/deb" lcs replay /home/empty.bag 2>"$work/error.txt" || fail "an empty bag is read"
grep -q 'needs the Python package rosbags' "$work/error.txt" ||
  fail "the reader of bags does not run: $(cat "$work/error.txt")"

# The example of the README on the installed wheel.
cp -a "$work/bookworm" "$work/wheel"
wheel=$(ls "$packages"/lcs-*.whl)
[[ $wheel == *-cp311-* ]] || skip "$wheel is not for Debian 12's Python, so the wheel is left out; all else passed"
cp "$wheel" "$work/wheel/tmp"
# shellcheck disable=SC2016  # the quotes are those of Markdown
sed -n '/^```python/,/^```/{/^```/d; p}' "$source/README.md" >"$work/wheel/home/example.py"
in_system "$work/wheel" sh -euc '
  apt-get update
  apt-get install -y --no-install-recommends python3-venv
  python3 -m venv /home/venv
  /home/venv/bin/pip install /tmp/lcs-*.whl' >"$work/pip.log" 2>&1 ||
  fail "the wheel cannot be installed: $(tail "$work/pip.log")"
score=$(in_system "$work/wheel" sh -euc 'cd /home && venv/bin/python example.py') ||
  fail "the README's example does not run on the wheel"
[[ $score =~ ^(0|1)(\.[0-9]+)?$ ]] || fail "the README's example printed '$score', no F1"
in_system "$work/wheel" sh -euc '
  cd /home
  venv/bin/python -c "import lcs; lcs.run(lcs.SCENARIOS / \"crossing.yaml\", out=\"run\")"' >/dev/null ||
  fail "lcs.run does not run on the wheel"
cmp "$work/wheel/home/run/layers.jsonl" "$work/run/layers.jsonl" || fail "the layers of the wheel are not those of the build"
