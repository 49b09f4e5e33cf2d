"""The commands of the program as functions. LCS_PROGRAM is the program, for its figures and tables."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import lcs

PROGRAM = os.environ.get("LCS_PROGRAM")
SCENARIO = """
frames: 6
scene: lab
groups: [short]
camera: {size: [320, 240]}
ego: {start: [-4 m, 0 m], speed: 0.5 m/s}
actors:
  box:
    shape: box
    size: [0.3 m, 0.3 m, 0.4 m]
    trajectory: {line: {from: [-1.5 m, 0.6 m], heading: -90 deg, speed: 0.5 m/s}}
"""
STILL = """
import json
import sys

picture = json.loads(sys.stdin.buffer.readline())["picture"]
print(json.dumps({"protocol": 1}), flush=True)
for line in sys.stdin.buffer:
    frame = json.loads(line)
    sys.stdin.buffer.read(picture["bytes"])
    print(json.dumps({"index": frame["index"]}), flush=True)
"""


def without_times(metrics):
    return {k: v for k, v in metrics.items() if not k.startswith(("time.", "sim.frames"))}


class InAFolder(unittest.TestCase):
    """Each class works in a folder of its own, since results go to out/ in the current one."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.addClassCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        Path("small.yaml").write_text(SCENARIO, encoding="utf-8")


class Suites(InAFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.calls = []
        cls.before = lcs.suite(
            "small.yaml",
            seeds=2,
            beside=["klt"],
            out="out/before",
            progress=lambda done, total: cls.calls.append((done, total)),
        )
        cls.after = lcs.suite(
            [Path("small.yaml")], seeds=2, detector="klt", out="out/after", baseline="out/before"
        )

    def test_has_a_row_for_each_run_of_each_detector(self):
        runs = {(run["detector"], run["seed"]): run for run in self.before["runs"]}
        self.assertEqual(set(runs), {("lcs", 1), ("lcs", 2), ("klt", 1), ("klt", 2)})
        self.assertEqual(self.before["outcome"], "passed")
        for (detector, seed), run in runs.items():
            self.assertEqual((run["scenario"], run["error"], run["family"]), ("small", "", None))
            stored = json.loads((run["folder"] / "metrics.json").read_text(encoding="utf-8"))
            self.assertEqual(run["metrics"], stored, (detector, seed))
        self.assertEqual(self.calls[-1], (2, 2))

    def test_a_mean_is_that_of_its_runs(self):
        rows = [row for row in self.before["means"] if row["detector"] == "lcs"]
        self.assertTrue(rows)
        for row in rows:
            self.assertIsNone(row["half"])  # no worlds: the noise over scenarios is unknown
            figures = [
                run["metrics"][row["metric"]]
                for run in self.before["runs"]
                if run["detector"] == "lcs" and run["metrics"].get(row["metric"]) is not None
            ]
            if figures:
                self.assertAlmostEqual(row["mean"], sum(figures) / len(figures), places=12)

    @unittest.skipUnless(PROGRAM, "LCS_PROGRAM does not name the program lcs")
    def test_compares_as_the_program_does(self):
        answer = lcs.compare("out/before", Path("out/after"))
        told = subprocess.run(
            [PROGRAM, "compare", "out/before", "out/after"], capture_output=True, text=True
        )
        codes = {"regressed": 1, "not judged": 2, "no regression found": 0, "equal": 0}
        self.assertEqual(told.returncode, codes[answer["finding"]], told.stderr)
        self.assertEqual(answer["regressed"], answer["finding"] == "regressed")
        self.assertIn(answer["text"], told.stdout)
        self.assertTrue(told.stdout.endswith(answer["verdict"] + "\n"))
        self.assertEqual(self.after["comparison"]["means"], answer["means"])
        for row in answer["scenarios"]:
            self.assertAlmostEqual(row["change"], row["after"] - row["before"], places=12)
            self.assertEqual(row["pairs"], 2)

    def test_refuses_as_the_program_does(self):
        with self.assertRaisesRegex(lcs.Error, "there is no such file|no folder|suite"):
            lcs.compare("nowhere", "out/after")
        with self.assertRaisesRegex(ValueError, "klt"):
            lcs.suite("small.yaml", detector="kltt")
        with self.assertRaisesRegex(ValueError, "paths and worlds"):
            lcs.suite("small.yaml", worlds="train")
        with self.assertRaisesRegex(ValueError, "figures, events or all"):
            lcs.suite("small.yaml", keep="some")
        with self.assertRaisesRegex(lcs.Error, "regular expression"):
            lcs.compare("out/before", "out/after", metric="(")

    def test_arguments_are_those_of_the_options(self):
        for call, said in (
            (lambda: lcs.suite("small.yaml", sede=3), "no argument 'sede'; the nearest is 'seeds'"),
            (lambda: lcs.suite("small.yaml", "more.yaml"), "1 arguments without a name, not 2"),
            (lambda: lcs.suite("small.yaml", paths="small.yaml"), "paths is given twice"),
            (lambda: lcs.merge(), "parts is missing"),
            (lambda: lcs.suite("small.yaml", jobs="two"), r"suite\(\): jobs is 'two'"),
            (lambda: lcs.suite("small.yaml", jobs=1.5), "jobs is 1.5"),
            (lambda: lcs.suite("small.yaml", beside="klt"), r"beside is 'klt': its type is List"),
            (lambda: lcs.suite("small.yaml", keep=3), "keep is 3"),
            (lambda: lcs.suite(worlds=None), "worlds is None"),
            (lambda: lcs.run(None), "scenario is None"),
        ):
            with self.assertRaisesRegex(TypeError, said):
                call()
        with self.assertRaisesRegex(lcs.Error, "--jobs: the number is"):
            lcs.suite("small.yaml", jobs=-1)
        with self.assertRaisesRegex(lcs.Error, "--frames: the number is"):
            lcs.run("small.yaml", frames="0")

    def test_a_default_may_be_given(self):
        plain = lcs.compare("out/before", "out/after")
        self.assertEqual(plain, lcs.compare("out/before", after="out/after", metric="", markdown=""))
        with self.assertRaisesRegex(lcs.Error, "nowhere.yaml"):
            lcs.generate("nowhere.yaml", frames=0, seed=None, formats=[], jobs=1, set=None, progress=None)

    def test_an_error_of_a_run_is_in_its_row(self):
        Path("broken.yaml").write_text("frames: many\n", encoding="utf-8")
        made = lcs.suite("broken.yaml", out="out/broken")
        self.assertEqual(made["outcome"], "error")
        self.assertIn("broken.yaml:1", made["runs"][0]["error"])
        self.assertIsNone(made["runs"][0]["folder"])

    def test_parts_are_merged(self):
        parts = [
            lcs.suite("small.yaml", seeds=2, shard=f"{i}/2", out=f"out/part{i}", keep="figures")
            for i in (1, 2)
        ]
        self.assertEqual([len(part["runs"]) for part in parts], [1, 1])
        whole = lcs.merge([part["folder"] for part in parts], out="out/whole")
        self.assertEqual(
            [without_times(run["metrics"]) for run in whole["runs"]],
            [without_times(run["metrics"]) for run in self.before["runs"] if run["detector"] == "lcs"],
        )

    def test_tune_states_what_the_present_numbers_are_worth(self):
        lcs.suite(worlds="train", count=1, set={"frames": 6}, out="out/train")
        made = lcs.tune("out/train", keys=["hypotheses.prior"], evaluations=1)
        self.assertEqual(made["before"], made["after"])
        self.assertEqual(set(made["before"]), {"hypotheses.prior"})
        self.assertEqual(made["stated"][0]["before"], made["stated"][0]["after"])
        self.assertIn(made["record"], (made["folder"] / "record.md").read_text(encoding="utf-8"))


class Interrupting(InAFolder):
    def test_ctrl_c_ends_a_suite_and_the_same_call_goes_on(self):
        one_is_done = threading.Event()

        def interrupt():  # runs meanwhile: the GIL is free
            one_is_done.wait()
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

        request = {"paths": "small.yaml", "seeds": 6, "jobs": 1, "keep": "figures"}
        thread = threading.Thread(target=interrupt)
        thread.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                lcs.suite(**request, progress=lambda done, total: one_is_done.set())
        finally:
            one_is_done.set()
        thread.join()
        self.assertFalse(Path("out/suite/suite.json").exists())
        with self.assertRaisesRegex(lcs.Error, "unfinished suite"):
            lcs.suite(**{**request, "seeds": 3})
        self.assertEqual(len(lcs.suite(**request)["runs"]), 6)

    def test_files_that_one_call_has_read_may_be_replaced(self):
        lcs.suite("small.yaml", seeds=1, out="out/again")
        lcs.compare("out/again", "out/again")
        self.assertEqual(lcs.suite("small.yaml", seeds=1, out="out/again")["outcome"], "passed")

    def test_an_error_of_progress_ends_a_run(self):
        def fail(done, total):
            raise KeyError(done, total)

        with self.assertRaises(KeyError) as raised:
            lcs.run("small.yaml", progress=fail)
        self.assertEqual(raised.exception.args, (1, 6))
        self.assertFalse(Path("out/small").exists())


class Runs(InAFolder):
    def test_a_detector_says_the_same_frame_by_frame_as_in_a_run(self):
        scenario = lcs.Scenario("small.yaml")
        for name in lcs.detectors():
            if name in ("program", "file"):
                continue
            with self.subTest(name):
                detector = lcs.Detector(scenario, name)
                self.assertEqual(detector.name, name)
                metrics = lcs.score((frame, detector.step(frame)) for frame in lcs.simulate(scenario))
                self.assertEqual(detector.finish(), [])
                made = lcs.run("small.yaml", detector=name, out=f"out/{name}")["detectors"][name]
                self.assertEqual(without_times(metrics), without_times(made["metrics"]))

    def test_a_stored_run_is_scored_again(self):
        begun = time.monotonic()
        made = lcs.run("small.yaml", out="out/stored")["detectors"]["lcs"]
        how = json.loads(Path("out/stored/run.json").read_text(encoding="utf-8"))
        self.assertLessEqual(how["wall_s"], time.monotonic() - begun)  # not since the import
        self.assertEqual(lcs.score("out/stored"), made["metrics"])
        Path("none.csv").write_text("0,circle\n", encoding="utf-8")
        self.assertEqual(lcs.score(Path("out/stored"), detections="none.csv")["rebel.recall"], 0)
        with self.assertRaisesRegex(lcs.Error, "nowhere is no folder"):
            lcs.score("nowhere")

    def test_a_program_is_a_detector(self):
        Path("still.py").write_text(STILL, encoding="utf-8")
        scenario = lcs.Scenario("small.yaml")
        detector = lcs.Detector(scenario, "still", command="python3 still.py")
        metrics = lcs.score((frame, detector.step(frame)) for frame in lcs.simulate(scenario))
        detector.finish()
        self.assertEqual(metrics["rebel.false_corners_per_frame"], 0)
        with self.assertRaisesRegex(lcs.Error, "nowhere.py"):
            lost = lcs.Detector(scenario, "lost", command="python3 nowhere.py")
            lost.step(next(lcs.simulate(scenario)))
        with self.assertRaisesRegex(ValueError, "klt"):
            lcs.Detector(scenario, "kltt")

    def test_a_program_outlives_the_thread_that_started_it(self):
        Path("still.py").write_text(STILL, encoding="utf-8")
        scenario = lcs.Scenario("small.yaml")
        made = []
        thread = threading.Thread(
            target=lambda: made.append(lcs.Detector(scenario, "still", command="python3 still.py"))
        )
        thread.start()
        thread.join()
        time.sleep(0.3)  # in which a signal would arrive
        self.assertEqual(len([made[0].step(frame) for frame in lcs.simulate(scenario)]), 6)
        made[0].finish()

    def test_a_program_is_a_detector_in_a_fork_and_ends_with_it(self):
        code = (
            "import lcs, os, time\n"
            "scenario = lcs.Scenario('small.yaml')\n"
            "first = lcs.Detector(scenario, 'still', command='python3 still.py')\n"
            "if os.fork() == 0:\n"
            "    own = lcs.Detector(scenario, 'still', command='python3 still.py of-the-fork')\n"
            "    print(os.getpid(), flush=True)\n"
            "    time.sleep(1000)\n"
            "os.wait()\n"
        )
        Path("still.py").write_text(STILL, encoding="utf-8")
        parent = subprocess.Popen(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            stdout=subprocess.PIPE,
        )
        forked = int(parent.stdout.readline())

        def of_the_fork():
            found = 0
            for file in Path("/proc").glob("[0-9]*/cmdline"):
                with contextlib.suppress(OSError):  # it has ended
                    found += b"still.py\0of-the-fork" in file.read_bytes()
            return found

        self.assertEqual(of_the_fork(), 1)
        os.kill(forked, signal.SIGKILL)
        parent.wait(timeout=60)
        parent.stdout.close()
        until = time.monotonic() + 20
        while of_the_fork() and time.monotonic() < until:
            time.sleep(0.01)
        self.assertEqual(of_the_fork(), 0)

    def test_a_sequence_is_replayed_as_it_was_run(self):
        made = lcs.generate("small.yaml", out="data/small", formats=["euroc", "landmarks"])
        self.assertEqual((made["folders"], made["frames"]), ([Path("data/small").absolute()], (0, 6)))
        self.assertEqual(lcs.generate("small.yaml", out="data/small", formats=["euroc", "landmarks"])["errors"], [])
        ran = lcs.run("small.yaml")["detectors"]["lcs"]["metrics"]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            replayed = lcs.replay("data/small", out="out/replayed")["detectors"]["lcs"]["metrics"]
        self.assertEqual(ran["rebel.f1"], replayed["rebel.f1"])
        with self.assertRaisesRegex(lcs.Error, "nowhere"):
            lcs.replay("nowhere")

    def test_worlds_are_drawn_and_generated_by_parts(self):
        files = lcs.worlds("train", count=2)
        self.assertEqual([lcs.Scenario(file).name for file in files], [file.stem for file in files])
        folders = []
        for shard in ("1/2", "2/2"):
            made = lcs.generate(
                worlds="train", count=2, shard=shard, formats=["tum"], frames=2, out="data"
            )
            self.assertEqual(made["errors"], [])
            folders += made["folders"]
        names = [f"{file.stem}-seed{file.stem.rsplit('_', 1)[1]}" for file in files]
        self.assertEqual(sorted(folder.name for folder in folders), sorted(names))
        with self.assertRaisesRegex(ValueError, "only 2 worlds"):
            lcs.generate(worlds="train", count=2, shard="1/3", out="data")
        drawn = lcs.world("room", 7, out="mine")
        self.assertEqual(drawn["file"], Path("mine/room_7.yaml").absolute())
        self.assertTrue(drawn["file"].exists())
        with self.assertRaisesRegex(ValueError, "room"):
            lcs.world("moon")


if __name__ == "__main__":
    unittest.main()
