"""Usage: compare.py LCS FOLDER WORK

Loads every MJCF file below FOLDER by MuJoCo and by `lcs preview`. What MuJoCo loads has to run, if
need be with its joints in a pose, or to be refused in one line with a reason of scenes/README.md.
"""

import collections
import pathlib
import re
import subprocess
import sys

lcs, folder, work = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
work.mkdir(parents=True, exist_ok=True)

# Words of a message, and the line of scenes/README.md that states the reason.
REASONS = {
    "plugins are not loaded": "plugins",
    "gravity must point along -z": "gravity",
    "planes? or height field; these are setting|has a plane or height field": "plane in a body",
    "is called like|repeated name|ego/": "a name of the rover's",
    r"\(limits|and can be|can have|sees no farther|needs too much memory|of processor time": "limits",
    "the physics failed": "unstable in MuJoCo, too, at its own step",
}
LOADS = "import mujoco, sys; mujoco.MjModel.from_xml_path(sys.argv[1])"


def loads(file):
    command = [sys.executable, "-c", LOADS, str(file)]
    try:
        return subprocess.run(command, capture_output=True, timeout=120, check=False).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def preview(file, pose):
    scenario = work / "scene.yaml"
    scenario.write_text(
        f'scene: "{file}"\n{pose}frames: 2\nego: {{start: [0 m, 0 m], speed: 0 m/s}}\n'
        "camera: {size: [160, 120]}\nimage: {noise: none}\n"
    )
    command = [lcs, "preview", str(scenario), "--quiet", "--force", "--out", str(work / "page.html")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    return done.returncode, done.stderr.strip()


def result(file):
    """The outcome in a word, and the message where it is wrong."""
    code, said = preview(file, "")
    pose = ""
    if code == 2 and "give the scenario a pose" in said:
        pose = "pose: zero\n"
        code, said = preview(file, pose)
    if code in (0, 1):
        return ("runs, posed" if pose else "runs"), ""
    if code != 2 or "\n" in said:
        return "WRONG", f"exit {code}: {said}"
    for words, reason in REASONS.items():
        if re.search(words, said):
            return f"refused: {reason}", ""
    return "WRONG", said


counts = collections.defaultdict(collections.Counter)
wrong = []
for file in sorted(folder.rglob("*.xml")):
    if not re.search(r"<mujoco\b", file.read_text(errors="replace")):
        continue
    package = file.relative_to(folder).parts[0]
    if not loads(file):
        counts[package]["not loaded by MuJoCo"] += 1
        continue
    word, said = result(file.resolve())
    counts[package][word] += 1
    if said:
        wrong.append(f"{file.relative_to(folder)}: {said}")
        print(wrong[-1], flush=True)

for package, words in counts.items():
    print(f"{package}: " + ", ".join(f"{n} {word}" for word, n in sorted(words.items())))
if not counts:
    sys.exit("FAILED: there are no scenes")
if wrong:
    sys.exit(f"FAILED: {len(wrong)} files load in MuJoCo and are refused for no stated reason")
