#!/usr/bin/env bash
# Usage: run.sh SUITE SOURCE WORK [TEST-OPTION]...
#
# Installs another system, a SUITE of Debian's, into WORK/SUITE, from where debootstrap has it by itself, copies SOURCE
# into it and has tools/test build and test it there: run.sh trixie . /tmp/systems
# What is there stays for the next time. Exits with 77, skipped, where that cannot be done here.
set -euo pipefail
suite=$1 source=$2 root=$3/$1
shift 3

skip() {
  printf 'SKIPPED: %s\n' "$*"
  exit 77
}

[[ $EUID -eq 0 ]] || skip "only root can install another system"
command -v debootstrap >/dev/null || skip "debootstrap is missing (Debian: debootstrap)"
unshare --mount true 2>/dev/null || skip "this machine allows no mounts"

if [[ ! -f $root/.whole ]]; then
  rm -rf "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" >"$root.log" 2>&1 || {
    cat "$root.log"
    grep -q 'Failed getting release file' "$root.log" && skip "the packages of $suite are not reachable"
    exit 1
  }
  touch "$root/.whole"
fi

mkdir -p "$root/lcs"
find "$root/lcs" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
tar -C "$source" --exclude='./build*' --exclude=./out --exclude=./.git -c . | tar -C "$root/lcs" -x

# The mounts are this process's own and end with it.
unshare --mount --pid --fork bash -euc '
  mount --rbind /dev "$0/dev"
  mount -t proc proc "$0/proc"
  exec chroot "$0" env -i HOME=/tmp PATH="$PATH" LANG=C.UTF-8 /lcs/tools/test "$@"' "$root" "$@"
