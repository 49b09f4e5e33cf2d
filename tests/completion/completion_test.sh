#!/usr/bin/env bash
# Usage: completion_test.sh PROGRAM COMPLETION
#
# Completes words of lcs in this bash as its readline does, and compares what is offered with what the
# program itself lists and takes.
set -euo pipefail
program=$1 completion=$2

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

# shellcheck source=tools/package/completion/lcs
. "$completion"
[[ $(complete -p lcs) == 'complete -o default -F _lcs_complete lcs' ]] ||
  fail "the shell completes lcs by: $(complete -p lcs)"

# offered WORD...: what is offered for the last word, sorted, a line each
offered() {
  local COMP_CWORD=$#
  local COMP_WORDS=("$program" "$@") COMPREPLY=(unset)
  _lcs_complete
  ((${#COMPREPLY[@]} == 0)) || printf '%s\n' "${COMPREPLY[@]}" | sort
}

# same WHAT OFFERED EXPECTED
same() {
  [[ $2 == "$3" ]] || fail "$1: offered $2, expected $3"
}

help=$("$program" --help)
commands=$(awk '/^Subcommands:/ {on = 1; next} /^$/ {on = 0} on && /^  [a-z]/ {print $1}' <<<"$help")
(($(wc -w <<<"$commands") > 10)) || fail "the program lists few commands: $commands"
same commands "$(offered '')" "$(sort <<<"--help
--version
$commands")"
for command in $commands; do
  offered "${command::2}" | grep -qx "$command" || fail "$command is not offered for ${command::2}"
  options=$("$program" "$command" --help | grep -oE '^  (-h,)?--[a-z-]+' | grep -oE -e '--[a-z-]+')
  same "options of lcs $command" "$(offered "$command" --)" "$(sort <<<"$options")"
done
[[ $(offered suite --wor) == $'--worlds\n--worst-first' ]] || fail "of --wor: $(offered suite --wor)"

names=$(offered run "")
for name in crossing night turning; do
  grep -qx "$name" <<<"$names" || fail "the scenario $name is not offered to lcs run"
done
same 'a part of a name' "$(offered run --no-video night_r)" night_rain
same 'the value of an option' "$(offered run --out '')" ''
same 'a folder of a run' "$(offered score '')" ''
same 'an unknown command' "$(offered nosuch '')" ''
echo 'lcs completes its commands, options and scenarios'
