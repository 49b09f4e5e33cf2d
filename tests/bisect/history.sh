#!/usr/bin/env bash
# history.sh LCS HISTORY WORK: the tests of tools/history, by the packages of PyPI that it needs.
set -euo pipefail
# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"
lcs=$1 history=$2 work=$3
mkdir -p "$work"
python3 -m venv "$work/venv" || skip "python3 -m venv does not work (Debian: python3-venv)"
"$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 30 numpy scipy &&
  "$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps apache-otava==0.8.0 ||
  skip "numpy, scipy and apache-otava cannot be installed from PyPI"
"$work/venv/bin/python" "$(dirname "${BASH_SOURCE[0]}")/history_test.py" "$lcs" "$history"
