#!/usr/bin/env bash
# Usage: read_back.sh LCS SCENARIOS WORK
#
# Generates sequences, installs evo, pycocotools, TrackEval and evlib in a separate folder, and reads the
# sequences with them. Then makes a small data set with GNU parallel, as in the documentation. Exits
# with 77, skipped, if the tools cannot be downloaded.
set -euo pipefail
lcs=$1 scenarios=$2 work=$3
here=$(dirname "${BASH_SOURCE[0]}")
frames=30

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

# Releases of TrackEval before 1.3 use names that NumPy 1.24 removed.
install_tools() {
  python3 -m venv "$work/venv" 2>/dev/null ||
    skip "the tools need a virtual environment (Debian: python3-venv, which tools/test --all installs)"
  local log=$work/pip.log
  if ! "$work/venv/bin/pip" install --disable-pip-version-check --retries 1 --timeout 30 --quiet \
    --only-binary :all: evo pycocotools 'trackeval>=1.3' pillow pyyaml evlib >"$log" 2>&1; then
    cat "$log"
    if is_offline "$log"; then
      skip "the Python package registry is not reachable, so there are no tools to read with"
    fi
    fail "pip does not install evo, pycocotools, trackeval and evlib"
  fi
}

spread() {
  if ! command -v parallel >/dev/null; then
    echo "not tested: GNU parallel is not installed (Debian: parallel, which tools/test --all installs)"
    return
  fi
  mkdir -p "$work/scenarios"
  for name in a b c d; do cp "$scenarios/crossing.yaml" "$work/scenarios/$name.yaml"; done
  PATH=$(dirname "$lcs"):$PATH parallel -j 2 lcs generate --suite "$work/scenarios" --frames 3 \
    --formats depth --out "$work/data" --shard {}/3 ::: 1 2 3
  for name in a b c d; do
    [[ -s $work/data/$name-seed1/manifest.json ]] || fail "parallel left no sequence $name"
  done
  echo "fine: GNU parallel made four sequences in three parts"
}

rm -rf "$work"
mkdir -p "$work"
spread
"$lcs" generate "$scenarios/crossing.yaml" --frames $frames --out "$work/sequence" --quiet
"$lcs" run "$scenarios/crossing.yaml" --set frames=$frames --out "$work/run" --no-video --quiet || [[ $? -eq 1 ]]
install_tools
# The HDF5 is written by the h5py that evlib brings.
LCS_PYTHON=$work/venv/bin/python "$lcs" generate "$scenarios/crossing.yaml" --frames 3 --set events={} \
  --formats events,dsec --out "$work/events" --quiet
MPLBACKEND=agg HOME=$work "$work/venv/bin/python" "$here/read_back.py" "$work/sequence" "$work/run" \
  "$work/tracks" "$work/events"
