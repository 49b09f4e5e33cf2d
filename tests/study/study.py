#!/usr/bin/env python3
"""From the paper's rules to ours, one at a time: measures the steps of the study.

    build/lcs suite --worlds train --count 60 --keep all --out out/train
    build/lcs suite --worlds test --count 60 --keep all --out out/test
    cmake --preset ci && cmake --build build --target steps
    tests/study/study.py out/train out/test

TRAIN and TEST are suites that `lcs suite --keep all` has kept; all steps run on their frames.
Writes the two tables of the section "From the paper's rules to ours" of filter/paper/STORY.md.

The rows are means over worlds: F1, precision and recall over the worlds with movers, the others
over all. The change of F1 against the row before has its 95 % interval over the worlds. Lines are
of code, without blanks and comments; the calls of a rule are not counted. The instructions of the
filter's step are counted by valgrind in two worlds of TRAIN, and left out without it. Takes half
an hour on two cores.
"""

import argparse
import csv
import json
import math
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STEPS = ROOT / "build/tests/study/steps"
PAGE = ROOT / "filter/paper/STORY.md"
HEAD = "## From the paper's rules to ours"
COUNTED = ("corridor_2", "garage_2")  # worlds of train, in which instructions are counted

# The code of a rule: marked blocks of step_edges.cpp; files; functions, as FILE:NAME.
EDGES = "filter/edges/"
CORRECTION = [f"{EDGES}track_loops.inl:{name}" for name in (
    "store_misses", "misses", "normal_sums", "agree", "off_segment")]
SCENE = [f"{EDGES}track_loops.inl:{name}" for name in (
    "bounds_at", "density_of_crossing", "show")]
VOTES = [f"{EDGES}association.cpp:best_pair"]

# rule, plain words, formulas, code, code in the same files that is of other rules
ROWS = [
    ("", "the paper's rules, preset `lab`", "", [], []),
    ("no_psi", "each corner is looked at in each frame: no ignored regions psi", "", [], []),
    ("velocity", "an edge's depth is a Kalman filter, not V^ = abs(V + r/t_f)", "(2), (12)",
     ["velocity"], []),
    ("gate", "an edge's corner is within three deviations, not within mu and delta_v", "(6)",
     ["gate"], []),
    ("signatures", "a pair needs similar signatures", "(7)", ["signatures"], []),
    ("coupling", "neighbours that move alike share their beliefs", "(18)-(20)",
     ["coupling", f"{EDGES}coupling.h", f"{EDGES}coupling.cpp"], []),
    ("two_sightings", "two sightings off the static images make a rebel, not three in line",
     "(13)", ["two_sightings"], []),
    ("hypotheses", "log odds of two hypotheses, each a Kalman filter, not xi, trust and alpha",
     "(4)-(7), (12)-(17)",
     [EDGES + name for name in ("tracks.h", "tracks.cpp", "track_loops.h", "track_loops.inl",
                                "association.h", "association.cpp", "corner_noise.h")],
     CORRECTION + SCENE + VOTES),
    ("votes", "neighbours vote for a pair", "(7)", VOTES, []),
    ("scene", "static points are above the ground, and outlines cross", "(3), (34)", SCENE, []),
    ("correction", "the told motion is corrected", "(8)-(11)",
     CORRECTION + [f"{EDGES}motion_fix.h", f"{EDGES}motion_fix.cpp"]
     + [f"{EDGES}edge_expert.cpp:{name}" for name in (
         "EdgeExpert::is_held", "EdgeExpert::is_first_wrong", "EdgeExpert::corrected",
         "EdgeExpert::do_all_move")], []),
    ("groups", "circles that one plane explains, their boxes, bodies that live on",
     "(21)-(25), (31)-(33)", ["filter/circles", "filter/squares"], []),
    ("radial", "movers along the line of sight: the default", "(27)-(30)",
     ["filter/radial", "filter/detect/gap_picture.h", "filter/detect/gap_picture.cpp"], []),
]
# Sets of rules without those before them in the table, and the worlds of train that they run in.
SETS = ["no_psi,signatures", "signatures,hypotheses", "coupling,hypotheses",
        "signatures,coupling,hypotheses"]
SET_WORLDS = [f"{family}_{seed}" for seed in range(1, 5) for family in (
    "corridor", "garage", "room", "street", "warehouse", "yard")]
FIGURES = ["F1", "precision", "recall", "false objects", "items"]


def code_lines(text):
    """The number of lines that are neither blank nor comments alone."""
    lines = [line.strip() for line in text.splitlines()]
    return sum(bool(line) and not line.startswith("//") for line in lines)


def lines_of(part):
    """The number of code lines of a part of ROWS."""
    if "/" not in part:
        text = (ROOT / "tests/study/step_edges.cpp").read_text()
        block = re.search(rf"// rule {part}\n(.*?)// end of rule {part}\n", text, re.S)
        return code_lines(block[1])
    file, _, name = part.partition(":")
    if name:  # from the line of the name, not indented, to the end of the body
        text = (ROOT / file).read_text()
        return code_lines(re.search(rf"^[^\s/][^\n]*\b{name}\(.*?^\}}", text, re.S | re.M)[0])
    path = ROOT / file
    files = list(path.glob("*.[hc]*")) if path.is_dir() else [path]
    return sum(code_lines(each.read_text()) for each in files)


def runs_of(suite):
    """The folders of the runs of a suite."""
    result = json.loads((suite / "suite.json").read_text())
    return [suite / run["folder"] for scenario in result["scenarios"] for run in scenario["runs"]]


def measured(runs, rules=None):
    """The rows of `steps` on some runs: of all steps, or of a set of rules."""
    def rows(run):
        words = [STEPS] + (["--rules", rules + ","] if rules else []) + [run]
        text = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        return list(csv.DictReader(text.splitlines()))

    with ThreadPoolExecutor(2) as pool:
        return [row for of_run in pool.map(rows, runs) for row in of_run]


def counted(run):
    """Step, corners, and instructions of the filter for each row of `steps` on a run."""
    with tempfile.TemporaryDirectory() as work:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={work}/profile",
             "--toggle-collect=lcs::study::StepFilter::step*",
             "--dump-after=lcs::study::end_of_step*", STEPS, run],
            check=True, capture_output=True, text=True)
        rows = []
        for part, row in enumerate(csv.DictReader(done.stdout.splitlines()), start=1):
            profile = Path(f"{work}/profile.{part}").read_text()
            count = int(re.search(r"^(?:totals|summary): (\d+)", profile, re.M)[1])
            rows.append((int(row["step"]), int(row["corners"]), count))
        return rows


def instructions(runs):
    """Of each step, for each corner, as text."""
    if not shutil.which("valgrind"):
        return ["-"] * len(ROWS)
    with ThreadPoolExecutor(2) as pool:
        rows = [row for of_run in pool.map(counted, runs) for row in of_run]
    sums = [[sum(row[i] for row in rows if row[0] == step) for i in (1, 2)]
            for step in range(len(ROWS))]
    return [f"{count / corners:.0f}" for corners, count in sums]


def mean(rows, name):
    """Over the worlds with movers, or over all."""
    if name in ("f1", "precision", "recall"):
        rows = [row for row in rows if row["f1"]]
    return statistics.mean(float(row[name]) for row in rows if row[name])


def change(rows, before):
    """The mean change of F1 over the worlds, with half of its 95 % interval."""
    old = {row["run"]: row["f1"] for row in before}
    changes = [float(row["f1"]) - float(old[row["run"]]) for row in rows if row["f1"]]
    half = 1.96 * statistics.stdev(changes) / math.sqrt(len(changes))
    return f"{statistics.mean(changes):+.3f}±{half:.3f}".replace("0.", ".")


def share(value):
    return f"{value:.3f}".removeprefix("0")


def cells(rows):
    """The figures of a row of a table."""
    shares = [share(mean(rows, name)) for name in ("f1", "precision", "recall")]
    return shares + [f"{mean(rows, name):.0f}" for name in ("false_objects", "items")]


def table(head, rows):
    return "".join("| " + " | ".join(row) + " |\n" for row in [head, ["---"] * len(head), *rows])


def steps_table(train, test, counts):
    """The table of all steps, from the rows of `steps`."""
    of_steps = [[[row for row in rows if int(row["step"]) == step] for rows in (train, test)]
                for step in range(len(ROWS))]
    rows = []
    for step, (_, words, formulas, code, others) in enumerate(ROWS):
        lines = sum(map(lines_of, code)) - sum(map(lines_of, others))
        what = f"{words}: {formulas}" if formulas else words
        grown = change(of_steps[step][1], of_steps[step - 1][1]) if step else ""
        on_train, on_test = of_steps[step]
        rows.append([str(step), what, str(lines) if step else "", share(mean(on_train, "f1")),
                     *cells(on_test), grown, counts[step]])
    return table(["step", "the new rule: its formulas in MODEL.md", "lines", "F1 on train",
                  *FIGURES, "change of F1", "instructions a corner"], rows)


def sets_table(runs, of_steps):
    """The table of SETS on some runs, between the first and the last step. of_steps: their rows."""
    def of(step):
        return cells([row for row in of_steps if row["run"] in map(str, runs)
                      and int(row["step"]) == step])

    return table(["only these rules", *FIGURES],
                 [["none", *of(0)],
                  *([rules.replace(",", ", "), *cells(measured(runs, rules))] for rules in SETS),
                  ["all", *of(len(ROWS) - 1)]])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("train", type=Path)
    parser.add_argument("test", type=Path)
    parser.add_argument("--print", action="store_true", help="only print the tables")
    options = parser.parse_args()
    train, test = runs_of(options.train), runs_of(options.test)
    counts = instructions([run for run in train if run.parts[-2] in COUNTED])
    on_train = measured(train)
    steps = steps_table(on_train, measured(test), counts)
    sets = sets_table([run for run in train if run.parts[-2] in SET_WORLDS], on_train)
    if options.print:
        print(steps, sets, sep="\n")
        return
    page = PAGE.read_text()
    start = page.index(HEAD)
    end = page.index("\n## ", start)
    old = list(re.finditer(r"(?:^\|.*\n)+", page[start:end], re.M))
    section = page[start:end].replace(old[0][0], steps).replace(old[1][0], sets)
    PAGE.write_text(page[:start] + section + page[end:])


if __name__ == "__main__":
    main()
