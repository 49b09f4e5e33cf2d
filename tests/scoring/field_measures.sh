#!/usr/bin/env bash
# Usage: field_measures.sh LCS WORK [COUNT]
#
# Scores COUNT worlds (default 20), installs TrackEval, pycocotools and scikit-learn in a separate folder,
# and compares the measures. Exits with 77, skipped, if the libraries cannot be downloaded.
set -euo pipefail
lcs=$1 work=$2 count=${3:-20}
here=$(dirname "${BASH_SOURCE[0]}")

# shellcheck source=tests/long_test.sh
. "$here/../long_test.sh"

rm -rf "$work"
mkdir -p "$work"
install "$work" --only-binary :all: pycocotools 'trackeval>=1.3' scikit-learn scikit-image opencv-python-headless
"$lcs" suite --worlds train --count "$count" --keep all --out "$work/suite" --quiet >"$work/suite.log" || [[ $? -eq 1 ]]
"$work/venv/bin/python" "$here/field_measures.py" "$work"/suite/runs/*/seed*
