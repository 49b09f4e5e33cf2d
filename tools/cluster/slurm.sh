#!/usr/bin/env bash
# Submits a suite to Slurm: a job array of its parts, and a job that merges them.
set -euo pipefail

refuse() {
  printf 'slurm.sh: %s (--help tells more)\n' "$*" >&2
  exit 2
}

if [[ ${1-} == -h || ${1-} == --help ]]; then
  cat <<'HELP'
Usage: tools/cluster/slurm.sh N DIR [SBATCH-OPTION]... -- LCS suite [ARGUMENT]...

Submits the suite in N parts, and a job that merges them into DIR. LCS is the program:

  tools/cluster/slurm.sh 16 out/train --partition=day --cpus-per-task=8 --time=4:00:00 -- \
    build/lcs suite --worlds train --count 1000 --baseline out/before

All nodes need this folder and the program at the same paths. A part uses the processors that Slurm gives
it. If its node fails, Slurm starts the part again, and finished runs are not repeated. After an error, a
limit of time or scancel, give the same command again, with --array=3,7 for these parts only.

SBATCH-OPTION is --name=value for sbatch. It holds for the parts and the merge. But --array=LIST is for
the parts only. With --wait the command ends with the merge, and has its exit status.
--baseline, --fail-on-regression and --worst-first are for the merge only.

Files: DIR.parts/I, each part; DIR.parts/I.log; DIR.parts/merge.log, with the table and the verdict.
Exit status: 0 submitted; 2 refused; with --wait that of the merged suite (lcs suite --help).
HELP
  exit 0
fi

[[ ${1-} =~ ^[1-9][0-9]{0,5}$ ]] || refuse "N must be a number of parts, not '${1-}'"
[[ ${2-} =~ ^[^-] ]] || refuse "DIR must be a folder, not '${2-}'"
out=${2%"${2##*[!/]}"} # without slashes at its end
[[ ! ${out##*/} =~ ^\.?\.?$ ]] || refuse "DIR must be a folder with a name, not '$2'"
[[ $out != *[%\\]* ]] || refuse "DIR must have no % and no backslash, which Slurm expands in the names of logs"
n=$1 parts=$out.parts array=1-$1 options=() wait=() end=()
shift 2
while [[ $# -gt 0 && $1 != -- ]]; do
  case $1 in
    --array=*) array=${1#*=} ;;
    --wait) wait=(--wait) ;;
    --dependency* | --output* | --parsable) refuse "${1%%=*} is set by this command" ;;
    --*) options+=("$1") ;;
    *) refuse "'$1' must be --name=value; the suite's command comes after --" ;;
  esac
  shift
done
[[ ${3-} == suite ]] || refuse "the suite's command is missing, as in: -- build/lcs suite --group all"
suite=("$2" suite) merge=("$2" merge)
shift 3
while [[ $# -gt 0 ]]; do
  case $1 in
    --shard* | --out* | --jobs*) refuse "${1%%=*} is set by this command" ;;
    --anew) refuse "--anew would drop finished runs each time that a part starts again; remove $parts" ;;
    --list) refuse "--list runs nothing" ;;
    --baseline) set -- "" "--baseline=${2-}" "${@:3}" ;;
    --baseline=*)
      [[ -e ${1#*=} ]] || refuse "there is no baseline '${1#*=}'"
      end+=("$1")
      ;;
    --fail-on-regression | --worst-first) end+=("$1") ;;
    *) suite+=("$1") ;;
  esac
  shift
done

"${suite[@]}" "${end[@]}" --shard "1/$n" --list >/dev/null # refuses now what each part would refuse
mkdir -p "$parts"
for ((i = 1; i <= n; ++i)); do merge+=("$parts/$i"); done
job=$(sbatch --parsable --job-name=lcs-suite --requeue --open-mode=append "${options[@]}" \
  --array="$array" --output="$parts/%a.log" <<END
#!/usr/bin/env bash
part=${parts@Q}/\$SLURM_ARRAY_TASK_ID
# A part of an earlier suite is not merged if this one fails.
((\${SLURM_RESTART_COUNT-0})) || rm -f "\$part/suite.json"
${suite[*]@Q} --shard "\$SLURM_ARRAY_TASK_ID/$n" --jobs "\$SLURM_CPUS_ON_NODE" --out "\$part" || status=\$?
exit \$((status == 1 ? 0 : status)) # The merge tells of missed criteria. The part has not failed.
END
)
echo "Submitted the parts as job $job; their logs are in $parts/"
exec sbatch --job-name=lcs-merge --requeue --open-mode=append "${options[@]}" "${wait[@]}" \
  --dependency="afterany:${job%;*}" --output="$parts/merge.log" <<END
#!/usr/bin/env bash
exec ${merge[*]@Q} ${end[*]@Q} --out ${out@Q}
END
