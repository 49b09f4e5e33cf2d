#!/usr/bin/env bash
# Usage: run.sh SUITE SOURCE WORK [TEST-OPTION]...
#
# Installs another system into WORK/SUITE, copies SOURCE into it and runs tools/test there: run.sh
# trixie . /tmp/systems. SUITE is one of Debian's, or noble, which is Ubuntu 24.04. The installation
# remains for the next run. Exits with 77, skipped, if this is not possible.
set -euo pipefail
suite=$1 source=$2 root=$3/$1
shift 3

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

[[ $EUID -eq 0 ]] || skip "only root can install another system"
command -v debootstrap >/dev/null || skip "debootstrap is missing (Debian: debootstrap)"
unshare --mount true 2>/dev/null || skip "this machine allows no mounts"

options=(--variant=minbase --include=ca-certificates) from=()
if [[ $suite == noble ]]; then
  # debootstrap has one script for all of Ubuntu's releases, under an old release's name.
  options+=(--components=main,universe)
  from=(http://archive.ubuntu.com/ubuntu gutsy)
fi

if [[ ! -f $root/.whole ]]; then
  rm -rf "$root"
  mkdir -p "$root"
  debootstrap "${options[@]}" "$suite" "$root" "${from[@]}" >"$root.log" 2>&1 || {
    cat "$root.log"
    grep -q 'Failed getting release file' "$root.log" && skip "the packages of $suite are not reachable"
    exit 1
  }
  touch "$root/.whole"
fi

# Where this machine reaches the package registry by settings and certificates of its own, the other
# system needs them, too.
for file in /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
  [[ ! -f $file ]] || cp --dereference "$file" "$root$file"
done

mkdir -p "$root/lcs"
find "$root/lcs" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
tar -C "$source" --exclude='./build*' --exclude=./.mujoco --exclude=./out --exclude=./.git -c . | tar -C "$root/lcs" -x

# The mounts are private to this process and end with it.
unshare --mount --pid --fork bash -euc '
  mount --rbind /dev "$0/dev"
  mount -t proc proc "$0/proc"
  exec chroot "$0" env -i HOME=/tmp PATH="$PATH" LANG=C.UTF-8 /lcs/tools/test "$@"' "$root" "$@"
