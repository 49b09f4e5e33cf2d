#!/usr/bin/env bash
# Usage: run.sh SOURCE BUILD [PATH]
#
# Runs clang-tidy with the checks of .clang-tidy over the files of PATH that BUILD compiles. PATH is
# a folder or a file of SOURCE; default: filter, sim, scenarios and tools. Exits with 1 on any
# finding or without files; with 77, skipped, without clang-tidy.
#
# Version 14 only, because the findings differ between versions.
set -euo pipefail
source=$(realpath "$1") build=$(realpath "$2") path=${3:-(filter|sim|scenarios|tools)}

if ! command -v run-clang-tidy-14 >/dev/null; then
  echo 'SKIPPED: there is no clang-tidy 14 (Debian: clang-tidy-14, which tools/test --all installs)'
  exit 77
fi

# Without (/|\$), a path would also match longer names that begin with it.
files="^$(sed 's/[][\.*^$+?(){}|]/\\&/g' <<<"$source")/$path(/|\$)"
log=$build/Testing/clang-tidy.log
mkdir -p "${log%/*}"
status=0
run-clang-tidy-14 -p "$build" -quiet -j "$(nproc)" "$files" 2>/dev/null |
  sed 's/\x1b\[[0-9;]*m//g' >"$log" || status=1  # without colours

grep -Ev '^clang-tidy' "$log" || true
looked_at=$(grep -Ec '^clang-tidy' "$log") || true
printf '%d files\n' "$looked_at"
[[ $looked_at -gt 0 ]] || {
  printf 'FAILED: %s compiles nothing of %s\n' "$build" "$path"
  status=1
}
exit "$status"
