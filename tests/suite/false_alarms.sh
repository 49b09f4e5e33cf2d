#!/usr/bin/env bash
# false_alarms.sh LCS FALSE_ALARMS: at most one in twenty comparisons of suites that differ in their
# seeds alone may be called a regression: of worlds with one seed, and of scenarios with two.
set -euo pipefail
lcs=$1 false_alarms=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$lcs" suite --worlds train --count 24 --seeds 4 --out worlds --quiet --keep figures
"$lcs" suite --filter 'crossing|approaching|lab' --seeds 4 --out scenarios --quiet --keep figures
"$false_alarms" worlds 1
"$false_alarms" scenarios 2
