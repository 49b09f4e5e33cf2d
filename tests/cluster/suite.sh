# Functions of the tests that run a suite in parts. They use $lcs and $work.
# shellcheck shell=bash
: "${lcs:?}" "${work:?}"

# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

# 14 short runs. With so few frames some miss their criteria: the exit code is 1.
suite=(--filter '^crossing' --seeds 2 --set frames=20)

make_whole() {
  local status=0
  "$lcs" suite "${suite[@]}" --out "$work/whole" >"$work/whole.log" 2>&1 || status=$?
  [[ $status == 1 ]] || fail "the suite in one go exits with $status: $(tail "$work/whole.log")"
}

# wait_for SECONDS WHAT COMMAND... waits until the command succeeds.
wait_for() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || fail "waited in vain for $what"
    sleep .1
  done
}

# Whether a run of the unfinished part is whole.
has_run() {
  compgen -G "$1.unfinished/in/runs/*/*/metrics.json"
}

# require_as_whole FOLDER compares it with the suite that was made in one go.
require_as_whole() {
  python3 - "$work/whole" "$1" <<'END' || fail "$1 is not as the suite that was made in one go"
import json, pathlib, sys

def timeless(value):
    if isinstance(value, list):
        return [timeless(one) for one in value]
    if not isinstance(value, dict):
        return value
    return {key: timeless(one) for key, one in value.items()
            if key != "wall_s" and not key.startswith(("time.", "sim."))}

whole, other = map(pathlib.Path, sys.argv[1:])
names = [{str(file.relative_to(folder)) for file in folder.rglob("*")} for folder in (whole, other)]
suites = [timeless(json.loads((folder / "suite.json").read_text())) for folder in (whole, other)]
runs = sum(len(scenario["runs"]) for scenario in suites[0]["scenarios"])
print(f"{other.name}: {runs} runs, {len(names[1])} files")
assert runs == 14 and names[0] == names[1], names[0] ^ names[1]
assert suites[0] == suites[1]
END
}
