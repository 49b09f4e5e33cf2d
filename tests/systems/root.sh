# Functions of the long tests that run in another operating system:
#   install_system SUITE ROOT    installs SUITE, of Debian or Ubuntu's noble, into ROOT unless it is there
#   in_system ROOT COMMAND...    runs COMMAND in ROOT, without the environment of the caller
# shellcheck shell=bash

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

install_system() {
  local suite=$1 root=$2 options=(--variant=minbase --include=ca-certificates) from=() file
  [[ $EUID -eq 0 ]] || skip "only root can install another system"
  command -v debootstrap >/dev/null || skip "debootstrap is missing (Debian: debootstrap)"
  unshare --mount true 2>/dev/null || skip "this machine allows no mounts"

  if [[ $suite == noble ]]; then
    # debootstrap has one script for all of Ubuntu's releases, under an old release's name.
    # shellcheck disable=SC2054
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

  # Where this machine reaches the package registry by settings and certificates of its own, the
  # other system needs them, too.
  for file in /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    [[ ! -f $file ]] || cp --dereference "$file" "$root$file"
  done
}

in_system() {
  # The mounts are private to this process and end with it.
  # shellcheck disable=SC2016
  unshare --mount --pid --fork bash -euc '
    mount --rbind /dev "$0/dev"
    mount -t proc proc "$0/proc"
    exec chroot "$0" env -i HOME=/tmp PATH="$PATH" LANG=C.UTF-8 "$@"' "$@"
}
