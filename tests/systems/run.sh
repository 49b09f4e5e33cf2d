#!/usr/bin/env bash
# Usage: run.sh SUITE SOURCE WORK [TEST-OPTION]...
#
# Installs another system into WORK/SUITE, copies SOURCE into it and runs tools/test there: run.sh
# trixie . /tmp/systems. SUITE is one of Debian's, or noble, which is Ubuntu 24.04. The installation
# remains for the next run. Exits with 77, skipped, if this is not possible.
set -euo pipefail
suite=$1 source=$2 root=$3/$1
shift 3

# shellcheck source=tests/systems/root.sh
. "$(dirname "${BASH_SOURCE[0]}")/root.sh"

install_system "$suite" "$root"

mkdir -p "$root/lcs"
find "$root/lcs" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
tar -C "$source" --exclude='./build*' --exclude=./.mujoco --exclude=./out --exclude=./.git -c . | tar -C "$root/lcs" -x

in_system "$root" /lcs/tools/test "$@"
