#!/usr/bin/env python3
"""tools/history on suites with a known change: history_test.py LCS HISTORY"""

import json
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

LCS, HISTORY = (Path(word).resolve() for word in sys.argv[1:3])


class History(unittest.TestCase):
    def setUp(self):
        self.home = tempfile.TemporaryDirectory()
        self.folder = Path(self.home.name) / "nightly"
        self.folder.mkdir()
        self.random = random.Random(1)

    def tearDown(self):
        self.home.cleanup()

    def add(self, night, f1, detector="lcs", scenarios=8, noise=0.002):
        """A suite of scenarios with an F1 of about `f1`."""

        def run(number):
            metrics = {"frames": 60, "rebel.f1": f1 - 0.02 * number + self.random.gauss(0, noise)}
            return {"seed": 1, "outcome": "passed", "error": "", "folder": "", "wall_s": 1,
                    "criteria": [], "metrics": metrics}  # fmt: skip

        suite = {"format": 1, "detector": detector, "sets": [],
                 "version": f"lcs 0.1.0 ({0xabc0000 + night:07x})",
                 "scenarios": [{"name": f"s{k}", "purpose": "", "file": "", "groups": ["short"],
                                "point": [], "runs": [run(k)]} for k in range(scenarios)]}  # fmt: skip
        (self.folder / f"night_{night:02}.json").write_text(json.dumps(suite))

    def history(self):
        out = Path(self.home.name) / "out"
        done = subprocess.run([sys.executable, HISTORY, self.folder, "--out", out, "--lcs", LCS],
                              text=True, capture_output=True, check=False)  # fmt: skip
        return done.returncode, done.stdout, done.stderr, out

    def test_marks_the_night_and_the_commit_of_a_step_and_no_other(self):
        for night in range(20):
            self.add(night, 0.8 if night < 12 else 0.75)
        code, said, wrong, out = self.history()
        self.assertEqual(code, 0, wrong)
        self.assertIn("night_12 (abc000c): rebel.f1 0.73", said)
        self.assertIn("20 suites, 1 changes", said)
        data = json.loads((out / "history.json").read_text())
        (change,) = data["changes"]
        self.assertEqual(change["at"], 12)
        self.assertTrue(change["worse"])
        self.assertIn("regressed: rebel.f1", change["text"])
        page = (out / "history.html").read_text()
        self.assertNotIn("{{", page[: page.index("<body>")])
        self.assertIn('"at": 12', page)

    def test_a_level_that_stays_has_no_change(self):
        for night in range(20):
            self.add(night, 0.8)
        self.assertIn("20 suites, 0 changes", self.history()[1])

    def test_means_are_over_the_runs_of_all_nights(self):
        for night in range(12):
            self.add(night, 0.8, scenarios=8 if night < 6 else 4, noise=0)
        data = json.loads((self.history()[3] / "history.json").read_text())
        self.assertEqual(data["changes"], [], "another mix of scenarios is no change")
        self.assertEqual(data["left_out"], [f"s{k} seed 1" for k in range(4, 8)])

    def test_a_night_whose_runs_all_failed_is_named(self):
        self.add(1, 0.8)
        self.add(2, 0.8, scenarios=0)
        self.assertIn("no run of night_02 has figures", self.history()[2])

    def test_suites_of_several_detectors_and_other_files_are_refused(self):
        self.add(1, 0.8)
        self.assertIn("has 1 suites", self.history()[2])
        self.add(2, 0.8, detector="klt")
        self.assertIn("several detectors or settings: klt , lcs", self.history()[2])
        (self.folder / "night_00.json").write_text("{}")
        code, _, wrong, _ = self.history()
        self.assertEqual(code, 1)
        self.assertIn("night_00.json: is no suite.json", wrong)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
