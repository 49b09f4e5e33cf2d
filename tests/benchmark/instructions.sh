#!/usr/bin/env bash
# Usage: instructions.sh LCS SCENARIO MOST
#
# Counts the instructions of Filter::step in a run of SCENARIO by callgrind. Exits with 1 if they are
# more than MOST for each corner; with 77, skipped, without valgrind.
set -euo pipefail
lcs=$1 scenario=$2 most=$3

if ! command -v valgrind >/dev/null; then
  echo 'SKIPPED: there is no valgrind (Debian: valgrind, which tools/test --all installs)'
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$lcs" run "$scenario" --no-video --quiet --out "$work/seen"
valgrind --tool=callgrind --callgrind-out-file="$work/profile" \
  --toggle-collect='lcs::Filter::Impl::step*' \
  "$lcs" run "$scenario" --no-video --quiet --recorded "$work/seen" --out "$work/again" \
  2>"$work/log" || { cat "$work/log"; exit 1; }
instructions=$(awk '/^totals:/ {print $2}' "$work/profile")
corners=$(awk -F, 'NR > 1 {sum += $3} END {print sum}' "$work/again/frames.csv")
printf '%d instructions for each of %d corners; at most %d\n' \
  $((instructions / corners)) "$corners" "$most"
[[ $instructions -gt 0 && $((instructions / corners)) -le $most ]]
