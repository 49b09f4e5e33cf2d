#!/usr/bin/env bash
# Usage: run.sh LCS WORK
#
# Recordings that other tools write, by PyPI's packages of them. Bags by rosbags: read_bag.py reads
# each format exactly, and `lcs replay` finds in a bag of a generated sequence the corners and rebels
# that it finds in its folder. `--formats mcap` by rosbags and mcap, `--formats rrd` by Rerun. A video
# by PyAV whose pictures have irregular times, as a phone's, with a camchain by PyYAML. Exits
# with 77, skipped, if the download fails.
set -euo pipefail
lcs=$1 work=$2
here=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=tests/long_test.sh
. "$here/../../long_test.sh"

export LCS_PYTHON=$work/python/bin/python
if [[ ! -x $LCS_PYTHON ]]; then
  python3 -m venv "$work/python" || skip "python3-venv is missing (tools/test --all installs it)"
fi
if ! "$LCS_PYTHON" -m pip install --quiet --retries 1 --timeout 30 rosbags==0.11.9 mcap av PyYAML \
  rerun-sdk==0.41.0 >"$work/pip.log" 2>&1; then
  is_offline "$work/pip.log" && skip "the package registry is not reachable"
  fail "$(cat "$work/pip.log")"
fi
"$LCS_PYTHON" "$here/bag_test.py"
"$LCS_PYTHON" "$here/neutral_test.py"
"$LCS_PYTHON" "$here/replay_test.py" "$lcs" "$work"
"$LCS_PYTHON" "$here/mcap_test.py" "$lcs" "$work"
"$LCS_PYTHON" "$here/rrd_test.py" "$lcs" "$work"
"$LCS_PYTHON" "$here/video_test.py" "$lcs" "$work"
