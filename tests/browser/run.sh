#!/usr/bin/env bash
# Usage: run.sh LCS SCENARIOS WORK
#
# Runs two small suites, the second one with the first as its baseline, and a single run, opens the page
# of each in a headless Chromium and uses it: headings sort, the filter filters, sections open, plots are
# drawn, pictures show, the video follows the plots, and the console stays empty. Exits with 77, skipped, where there is no Chromium.
set -euo pipefail
lcs=$1 scenarios=$2 work=$3
here=$(dirname "${BASH_SOURCE[0]}")

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

chromium=$(command -v chromium || command -v chromium-browser || true)
if [[ -z $chromium ]]; then
  echo 'SKIPPED: there is no Chromium (Debian: chromium, which tools/test --all installs)'
  exit 77
fi

rm -rf "$work"
mkdir -p "$work"
suite() {
  "$lcs" suite "$scenarios/approaching.yaml" "$scenarios/lab.yaml" --seeds 2 --set frames=20 --quiet \
    "$@" || [[ $? -eq 1 ]]  # failed criteria do not matter here
}
suite --out "$work/first"
suite --out "$work/second" --set filter.preset=lab \
  --baseline "$work/first/suite.json"
"$lcs" run "$scenarios/crossing.yaml" --frames 12 --report --quiet --out "$work/run" || [[ $? -eq 1 ]]

# browse PAGE: prints the page's DOM after its use on stdout.
browse() {
  "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
    --disable-background-networking --disable-component-update --disable-sync \
    --user-data-dir="$work/profile" --enable-logging=stderr --virtual-time-budget=60000 \
    --dump-dom "file://$1" 2>"$work/log"
}

for name in first second run; do
  report=$work/$name/report.html
  [[ -s $report ]] || fail "$name left no report.html"
  # A copy of the page with a listener before everything else and the exercise at the end.
  used=$work/$name.html
  awk -v exercise="$here/exercise.js" '
    /^<head>$/ {
      print
      print "<script>window.faultsOnLoad = [];"
      print "addEventListener(\"error\", (e) => faultsOnLoad.push(\"error: \" + e.message), true);"
      print "addEventListener(\"unhandledrejection\", (e) => faultsOnLoad.push(\"rejected: \" + e.reason));"
      print "addEventListener(\"securitypolicyviolation\", (e) => faultsOnLoad.push(\"fetched: \" + e.blockedURI));"
      print "</script>"
      next
    }
    /^<\/body>$/ {
      print "<script>"
      while ((getline line < exercise) > 0) print line
      print "</script>"
    }
    { print }' "$report" >"$used"
  browse "$used" >"$work/$name.dom" || fail "Chromium ended with $?: $(tail -n 3 "$work/log")"
  if grep -F 'CONSOLE' "$work/log"; then fail "$name: the console is not empty"; fi
  if ! grep -qF '>EXERCISE-FINE<' "$work/$name.dom"; then
    grep -oE 'EXERCISE-FAULTS .*' "$work/$name.dom" | head -c 2000 || true
    fail "$name: the page does not do what it should"
  fi
  echo "$name: fine"
done
