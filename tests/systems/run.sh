#!/usr/bin/env bash
# Usage: run.sh SUITE MIRROR SOURCE WORK [TEST-OPTION]...
#
# Installs another system, a SUITE of Debian's or Ubuntu's, into WORK/SUITE, copies SOURCE into it and
# has tools/test build and test it there: run.sh trixie http://deb.debian.org/debian . /tmp/systems
# What is there stays for the next time. Exits with 77, skipped, where that cannot be done here.
set -euo pipefail
suite=$1 mirror=$2 source=$3 root=$4/$1
shift 4

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
  from=(main)
  [[ $mirror != */ubuntu ]] || from=(main,universe /usr/share/debootstrap/scripts/gutsy)
  debootstrap --variant=minbase --include=ca-certificates --components="${from[0]}" \
    "$suite" "$root" "$mirror" "${from[@]:1}" >"$root.log" 2>&1 || {
    cat "$root.log"
    grep -q 'Failed getting release file' "$root.log" && skip "$mirror is not reachable"
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
  exec chroot "$0" env -i HOME=/root PATH="$PATH" LANG=C.UTF-8 /lcs/tools/test "$@"' "$root" "$@"
