#!/usr/bin/env bash
# Usage: install.sh SOURCE WORK LCS
#
# Installs SOURCE/tools/python by pip in a fresh virtual environment, as its README says, and runs
# its tests with the installed package from another folder; LCS is the program for comparing the
# bits. Exits with 77, skipped, if pip cannot download its build requirements.
set -euo pipefail
source=$1 work=$2 lcs=$3

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

rm -rf "$work"
mkdir -p "$work"
cd "$work"
python3 -m venv venv 2>/dev/null ||
  skip "pip needs a virtual environment (Debian: python3-venv, which tools/test --all installs)"
if ! venv/bin/pip install --disable-pip-version-check --retries 1 --timeout 30 "$source/tools/python" \
  >pip.log 2>&1; then
  cat pip.log
  if is_offline pip.log; then
    skip "the Python package registry is not reachable, so there is nothing to build with"
  fi
  fail "pip does not install the package"
fi

# Detects a package that reads its scene from SOURCE.
installed=$(venv/bin/python -c 'import lcs; print(lcs.SCENARIOS.parent)')
[[ $installed == "$work"/venv/* && -f $installed/scenes/lab.xml && -f $installed/../../py.typed ]] || {
  printf 'FAILED: the installed package is not whole: %s\n' "$installed"
  exit 1
}
unset PYTHONPATH
export LCS_PROGRAM=$lcs PYTHONDONTWRITEBYTECODE=1
for test in api same_bits readme notebook; do
  venv/bin/python "$source/tests/python/${test}_test.py"
done
