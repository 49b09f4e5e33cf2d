#!/usr/bin/env python3
"""tools/bisect on small repositories of a detector: bisect_test.py LCS BISECT"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

LCS, BISECT = (Path(word).resolve() for word in sys.argv[1:3])

# Calls so many of the first corners of each frame rebels, from frame 2 on, and with noise more.
DETECTOR = """
import json, os, random, sys
REBELS, NOISE = 0, 0
open(os.path.join(os.environ["LCS_REPOSITORY"], "starts"), "a").write("x")
source = sys.stdin.buffer
size = json.loads(source.readline())["picture"]["bytes"]
print(json.dumps({"protocol": 1}), flush=True)
for line in iter(source.readline, b""):
    frame = json.loads(line)
    source.read(size)
    rebels = REBELS + random.randint(0, NOISE) if frame["index"] >= 2 else 0
    some = list(range(min(rebels, len(frame["corners"]["x"]))))
    print(json.dumps({"index": frame["index"], "rebel": some}), flush=True)
"""
BOX = ("<body name='box_{0}' pos='{0} {1} .3'>"
       "<geom type='box' size='.2 .2 .3' rgba='.9 .2 .2 1'/></body>")  # fmt: skip
SCENE = ("<mujoco><worldbody><light pos='0 0 5'/><geom name='floor' type='plane' size='20 20 .1'/>"
         + "".join(BOX.format(i, i % 3 - 1) for i in range(9)) + "</worldbody></mujoco>")  # fmt: skip
SCENARIO = """purpose: boxes
scene: boxes.xml
frames: 6
ego: {start: [-4 m, 0 m], speed: 0.5 m/s}
camera: {size: [160, 120]}
"""


class Bisect(unittest.TestCase):
    def setUp(self):
        self.home = Path(tempfile.mkdtemp()).resolve()
        self.repository = self.home / "repository"
        self.repository.mkdir()
        (self.home / "boxes.xml").write_text(SCENE)
        (self.home / "boxes.yaml").write_text(SCENARIO)
        self.git("init", "--quiet")

    def tearDown(self):
        shutil.rmtree(self.home)

    def git(self, *words):
        named = ("-c", "user.name=test", "-c", "user.email=test@example.org")
        subprocess.run(["git", *named, *words], cwd=self.repository, check=True)

    def commits(self, changed_at, broken=(), rebels=3, noise=0):
        """Seven commits: from `changed_at` on corners are rebels; `broken` cannot be built."""
        for k in range(7):
            text = DETECTOR.replace("= 0, 0", f"= {rebels if k >= changed_at else 0}, {noise}")
            (self.repository / "mine.py").write_text(text)
            (self.repository / "built").write_text("1" if k in broken else "0")
            (self.repository / "notes").write_text(str(k))
            self.git("add", "mine.py", "built", "notes")
            self.git("commit", "--quiet", "--message", f"change {k}")

    def words(self, *more, ends=("HEAD~6", "HEAD"), by=("--frames",), seeds=1):
        return [BISECT, *by, "--repository", self.repository, "--build", "exit $(cat built)",
                "--out", self.home / "found", *ends, self.home / "boxes.yaml", "--seeds", str(seeds),
                "--detector-command", "python3 mine.py", *more]  # fmt: skip

    def bisect(self, *more, **options):
        done = subprocess.run(self.words(*more, **options), cwd=self.home, text=True,
                              capture_output=True, env={**os.environ, "LCS_PROGRAM": str(LCS)})
        return done.returncode, done.stdout, done.stderr  # fmt: skip

    def starts(self):
        log = self.repository / "starts"
        return len(log.read_text()) if log.exists() else 0

    def test_names_the_commit_and_the_first_frame(self):
        self.commits(changed_at=4)
        code, out, err = self.bisect()
        self.assertEqual(code, 0, err)
        self.assertIn("is the first commit that differs: change 4\n", out)
        self.assertIn("boxes seed 1: frame 2 (t = 0.200 s) is the first of 4 that differ", out)
        self.assertIn(" px: normal -> rebel\n", out)
        answer = (self.home / "found/answer.md").read_text()
        self.assertIn("is the first commit that differs: change 4\n", answer)
        self.assertIn("![frame 2](frames/before.jpg) | ![frame 2](frames/after.jpg)", answer)
        before, after = ((self.home / "found/frames" / name).read_bytes()
                         for name in ("before.jpg", "after.jpg"))  # fmt: skip
        self.assertTrue(before.startswith(b"\xff\xd8") and after.startswith(b"\xff\xd8"))
        self.assertNotEqual(before, after)  # rebels where nothing moves have crosses

    def test_tells_a_change_from_the_noise_of_a_detector(self):
        self.commits(changed_at=4, rebels=30, noise=2)
        code, _, err = self.bisect()
        self.assertEqual(code, 2)
        self.assertIn("HEAD~6 differs from itself in another run: different: 1 of 1 run", err)
        self.assertIn("repeat the suites by --repeat", err)
        shutil.rmtree(self.home / "found")
        self.git("worktree", "prune")
        code, out, err = self.bisect("--repeat", "3", by=(), seeds=3)
        self.assertEqual(code, 0, err)
        self.assertIn("is the first commit that differs: change 4\n", out)
        self.assertIn("3 of 3 suites differ", err)
        self.assertIn("0 of 3 suites differ", err)
        self.assertIn("takes 1 to 99", self.bisect("--repeat", "0", by=())[2])
        self.assertIn("--repeat is for figures", self.bisect("--repeat", "2")[2])

    def test_skips_a_commit_that_cannot_be_built(self):
        self.commits(changed_at=5, broken=[3])
        code, out, err = self.bisect()
        self.assertEqual(code, 0, err)
        self.assertIn("differs: change 5\n", out)

    def test_skips_a_commit_whose_detector_fails_also_when_it_goes_on(self):
        self.commits(changed_at=5)
        self.git("checkout", "--quiet", "--detach", "HEAD~3")
        text = (self.repository / "mine.py").read_text()
        (self.repository / "mine.py").write_text("raise SystemExit(3)")
        self.git("commit", "--quiet", "--all", "--message", "breaks it")
        changed = text.replace("REBELS, NOISE = 0", "REBELS, NOISE = 3")
        (self.repository / "mine.py").write_text(changed)
        self.git("commit", "--quiet", "--all", "--message", "mends it, and changes it")
        for _ in range(2):
            code, _, err = self.bisect(ends=("HEAD~4", "HEAD"))
            self.assertEqual(code, 2)  # either of the last two
            self.assertIn("only 'skip'ped commits left", err)

    def test_says_which_commits_it_could_not_tell_apart(self):
        self.commits(changed_at=4, broken=[4])
        code, _, err = self.bisect()
        self.assertEqual(code, 2)
        self.assertIn("only 'skip'ped commits left", err)

    def test_refuses_ends_that_do_not_differ(self):
        self.commits(changed_at=9)
        code, _, err = self.bisect()
        self.assertEqual(code, 2)
        self.assertIn("do not differ: equal: 0 of 1 run differ, in 0 of 6 frames", err)

    def test_refuses_an_end_that_cannot_be_built_and_ends_that_are_turned(self):
        self.commits(changed_at=4, broken=[0])
        code, _, err = self.bisect()
        self.assertEqual(code, 2)
        self.assertIn("cannot be built or run; see ", err)
        code, _, err = self.bisect(ends=("HEAD", "HEAD~6"))
        self.assertEqual(code, 2)
        self.assertIn("HEAD is no ancestor of HEAD~6", err)
        self.assertIn("nowhere is no commit", self.bisect(ends=("nowhere", "HEAD"))[2])

    def test_goes_on_after_it_was_ended_and_refuses_the_place_of_another_search(self):
        self.commits(changed_at=2)
        process = subprocess.Popen(self.words(), cwd=self.home, start_new_session=True,
                                   env={**os.environ, "LCS_PROGRAM": str(LCS)},
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
        while process.poll() is None and self.starts() < 2:
            time.sleep(0.005)
        os.killpg(process.pid, 9)
        process.wait()
        self.assertLess(self.starts(), 5, "it was done before it could be ended")
        code, _, err = self.bisect("--set", "filter.line.x=1")
        self.assertEqual(code, 2)
        self.assertIn("holds the results of another search", err)
        code, out, err = self.bisect()
        self.assertEqual(code, 0, err)
        self.assertIn("differs: change 2\n", out)
        # The good end is run twice, the other and three commits between once, and one that was
        # ended perhaps again.
        self.assertLessEqual(self.starts(), 7)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
