#!/usr/bin/env python3
"""Plants faults in the filter, one at a time, and counts how many are found.

faults.py LCS REPOSITORY WORK [--first N] [--count N] [--worlds N]

For each fault a scratch clone gets a history of 64 commits, of which one has the fault. tools/bisect
searches it, and has to name that commit, and the first frame that differs, which this script finds
by itself from the lines of layers.jsonl. Then the faulty filter runs on recorded worlds of the split
train, against the filter as it is: the table shows the change of F1, the verdict, and how many of
the worlds it took. Ends with 1 if a search names another commit or frame.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

COMMITS = 64
SCENARIO = "crossing"

# File below filter/, its text, and the faulty text; from gross faults to small ones.
FAULTS = [
    ("edges/coupling.cpp", "J = static_cast<float>(most);", "J = 0.0F * static_cast<float>(most);"),
    ("edges/coupling.cpp", "J = static_cast<float>(most);", "J = 0.5F * static_cast<float>(most);"),
    ("edges/coupling.cpp", "J = static_cast<float>(most);", "J = 0.9F * static_cast<float>(most);"),
    ("edges/coupling.cpp", "std::exp(-0.5 * kFar * kFar)", "std::exp(-0.2 * kFar * kFar)"),
    ("edges/association.cpp", "2 * alike_[i].bits <= most_bits_", "alike_[i].bits <= most_bits_"),
    ("edges/association.cpp", "pair.weight -= ln_clutter;", "pair.weight -= 2 * ln_clutter;"),
    ("edges/association.cpp", "> 0 ? kMovingX : kStaticX", "<= 0 ? kMovingX : kStaticX"),
    ("edges/association.cpp", "predicted.at(kSightings, t) < 3", "predicted.at(kSightings, t) < 6"),
    ("edges/edge_expert.cpp", "double{shown_[c]},", "0.9 * double{shown_[c]},"),
    ("edges/edge_expert.cpp", "double{shown_[c]},", "double{shown_[c]} + 1,"),
    ("edges/edge_expert.cpp", "record.unseen++ >= parameters_.coast", "record.unseen++ >= 0"),
    ("edges/edge_expert.cpp", "predict(right, frame_of(right), predicted_);",
     "predict(field, frame_of(field), predicted_);"),
    ("edges/edge_expert.cpp", "noise2_px2_ = std::max(least2, noise_",
     "noise2_px2_ = std::max(9 * least2, noise_"),
    ("circles/motion_groups.cpp", "constexpr double kNear = 2;", "constexpr double kNear = -2;"),
    ("circles/motion_groups.cpp", "kNear - link.cost;", "kNear - 3 * link.cost;"),
    ("circles/motion_groups.cpp", "parameters_.roughness * value.norm()",
     "0.2 * parameters_.roughness * value.norm()"),
    ("squares/bodies.cpp", "constexpr double kSame = 0.5;", "constexpr double kSame = 0.95;"),
    ("squares/bodies.cpp", "constexpr double kInner = 0.5;", "constexpr double kInner = 0.05;"),
    ("radial/comers.cpp", "(now - before) / parameters_.memory", "(now - before)"),
    ("edges/motion_fix.cpp", "constexpr double kTurn_rad = 1e-3;", "constexpr double kTurn_rad = 1e-5;"),
]  # fmt: skip


def run(*words, cwd=None, check=True, env=None):
    done = subprocess.run([str(w) for w in words], cwd=cwd, text=True, capture_output=True, env=env)
    if check and done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done


class Clone:
    """A scratch clone with a history of commits that change nothing, and a build. Its path is as long
    as that of the tree of tools/bisect, so that a cache of the compiler serves both."""

    def __init__(self, repository, work):
        self.folder = work / "clone/tree"
        if not self.folder.exists():
            run("git", "clone", "--quiet", repository, self.folder)
            (self.folder / ".mujoco").symlink_to(repository / ".mujoco")
        self.git("checkout", "--quiet", "--force", "--detach", "origin/HEAD")
        self.base = self.git("rev-parse", "HEAD").strip()

    def git(self, *words):
        named = ("-c", "user.name=test", "-c", "user.email=test@example.org")
        return run("git", *named, *words, cwd=self.folder).stdout

    def change(self, path, old, new):
        file = self.folder / "filter" / path
        text = file.read_text()
        if text.count(old) != 1:
            sys.exit(f"{path} has {text.count(old)} times {old!r}; correct the list of faults")
        file.write_text(text.replace(old, new))

    def history(self, fault, at):
        """Commits the history. Returns the commits, of which `at` has the fault."""
        self.git("checkout", "--quiet", "--force", "--detach", self.base)
        commits = [self.base]
        for k in range(1, COMMITS):
            if k == at:
                self.change(*fault)
            else:
                with open(self.folder / "filter/HISTORY.md", "a", encoding="utf-8") as file:
                    file.write(f"\nNote {k}.\n")
            self.git("commit", "--quiet", "--all", "--message", f"Change {k}")
            commits.append(self.git("rev-parse", "HEAD").strip())
        return commits

    def build(self):
        run("cmake", "--preset", "ci", "-B", "build", cwd=self.folder)
        run("cmake", "--build", "build", "--target", "lcs", cwd=self.folder)
        return self.folder / "build/lcs"

    def layers(self, out):
        run(self.folder / "build/lcs", "run", SCENARIO, "--seed", 1, "--no-video", "--out", out,
            "--quiet", cwd=self.folder, check=False)  # fmt: skip
        return (out / "layers.jsonl").read_text().splitlines()


def mean_f1(suite):
    values = [
        run["metrics"]["rebel.f1"]
        for scenario in json.loads((suite / "suite.json").read_text())["scenarios"]
        for run in scenario["runs"]
        if run["metrics"].get("rebel.f1") is not None
    ]
    return sum(values) / len(values)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("lcs", type=lambda text: Path(text).resolve())
    parser.add_argument("repository", type=lambda text: Path(text).resolve())
    parser.add_argument("work", type=lambda text: Path(text).resolve())
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=len(FAULTS))
    parser.add_argument("--worlds", type=int, default=40)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    clone = Clone(options.repository, options.work)
    own = clone.build()
    usual = clone.layers(options.work / "usual")
    recorded = options.work / "recorded"
    if not recorded.exists():
        run(own, "suite", "--worlds", "train", "--count", options.worlds, "--out", recorded,
            "--quiet", cwd=options.work, check=False)  # fmt: skip
    again = ("suite", "--worlds", "train", "--count", options.worlds, "--recorded", recorded,
             "--keep", "figures", "--quiet")  # fmt: skip
    before = options.work / "before"
    run(own, *again, "--out", before, cwd=options.work, check=False)

    print("| fault | first frame | bisect | time, s | change of F1 | verdict | runs |")
    print("|---|---|---|---|---|---|---|", flush=True)
    wrong = regressed = 0
    for k in range(options.first, min(len(FAULTS), options.first + options.count)):
        at = 2 + (k * 23) % (COMMITS - 4)
        commits = clone.history(FAULTS[k], at)
        faulty = clone.build()
        lines = clone.layers(options.work / "faulty")
        differs = [i for i, (a, b) in enumerate(zip(usual, lines)) if a != b]
        start = time.monotonic()
        search = options.work / "bisect"
        for kept in search.glob("*"):
            if kept.name != "tree":  # the builds go on
                shutil.rmtree(kept) if kept.is_dir() else kept.unlink()
        found = run(options.repository / "tools/bisect", "--frames", "--repository", clone.folder,
                    "--out", search, commits[0], commits[-1], SCENARIO, "--seeds", 1,
                    check=False, env={**os.environ, "LCS_PROGRAM": str(options.lcs)})  # fmt: skip
        took = time.monotonic() - start
        if differs:
            is_right = f"{commits[at]} is the first" in found.stdout and (
                f"frame {differs[0]} (t = " in found.stdout)  # fmt: skip
        else:
            is_right = found.returncode == 2 and "do not differ" in found.stderr
        wrong += not is_right
        if not is_right:
            print(found.stdout, found.stderr, file=sys.stderr)
        after, all_runs = options.work / "after", options.work / "all"
        stopped = run(faulty, *again, "--baseline", before, "--fail-on-regression", "--out", after,
                      cwd=options.work, check=False)  # fmt: skip
        run(faulty, *again, "--out", all_runs, cwd=options.work, check=False)
        verdict = next((line for line in stopped.stderr.splitlines() if "against " in line), "")
        looked = json.loads((after / "suite.json").read_text()).get("sequential", {})
        regressed += "regressed: " in verdict
        print(f"| {FAULTS[k][2]} | {differs[0] if differs else 'none'} | "
              f"{'right' if is_right else 'WRONG'} | {took:.0f} | "
              f"{mean_f1(all_runs) - mean_f1(before):+.3f} | "
              f"{'regressed' if 'regressed: ' in verdict else 'not regressed'} | "
              f"{looked.get('runs')} of {looked.get('planned')} |", flush=True)  # fmt: skip
    print(f"{wrong} searches are wrong; {regressed} faults are told as regressions")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
