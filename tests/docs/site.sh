#!/usr/bin/env bash
# Usage: site.sh SOURCE
#
# Builds the documentation site. mkdocs fails on a dead link, Doxygen on a comment that it cannot read.
set -euo pipefail
source=$1

python3 -m pip download --quiet --no-deps --dest "$(mktemp -d)" --requirement "$source/tools/docs/requirements.txt" >/dev/null 2>&1 || {
  echo "SKIPPED: mkdocs cannot be downloaded here"
  exit 77
}
"$source/tools/docs/build"
site=$source/build/site

expect() {
  grep -q -- "$2" "$site/$1" || { printf 'FAILED: %s lacks: %s\n' "$1" "$2"; exit 1; }
}
expect index.html 'LCS test bench'
expect keys.html 'camera.rate\|rate'
expect python.html 'simulate'
expect filter/MODEL.html 'class="arithmatex"'
expect search/search_index.json 'rebel'
expect cpp/annotated.html 'FrameResult'
[[ -s $site/katex/katex.min.js && -s $site/katex/fonts/KaTeX_Main-Regular.woff2 ]]
! grep -rl --include='*.html' 'https://cdn\|https://fonts' "$site" || { echo 'FAILED: a page loads from another host'; exit 1; }
