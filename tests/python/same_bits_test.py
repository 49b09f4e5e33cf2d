"""What comes through Python is what the program writes, to the bit. LCS_PROGRAM is the program."""

import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import lcs

PROGRAM = os.environ.get("LCS_PROGRAM")
SETTINGS = {"frames": 15, "criteria": "[]"}
SEED = 3


def lines_of(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def decoded(word, shape):
    """COCO's word of a mask, as pycocotools decodes it."""
    runs, number, shift = [], 0, 0
    for letter in word:
        bits = ord(letter) - 48
        number |= (bits & 31) << shift
        shift += 5
        if bits & 32:
            continue
        if bits & 16:
            number -= 1 << shift
        runs.append(number + (runs[-2] if len(runs) > 2 else 0))
        number = shift = 0
    inside = np.arange(len(runs)) % 2 == 1
    return np.repeat(inside, runs).reshape(shape, order="F")


def is_of_times(name):
    return name.startswith("time.") or name == "sim.frames_per_second"


@unittest.skipUnless(PROGRAM, "LCS_PROGRAM does not name the program lcs")
class SameBits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)

    def program(self, *arguments):
        subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def run_program(self, scenario):
        out = Path(self.folder.name) / scenario.stem
        sets = [f"--set={key}={value}" for key, value in SETTINGS.items()]
        self.program("run", scenario, *sets, "--seed", SEED, "--no-video", "--quiet", "--out", out)
        return out

    def assert_columns(self, rows, columns, what):
        """columns: of a file, null for what is not finite, words for enumerators."""
        words = {"label": lcs.Label}
        for name, expected in columns.items():
            if name in words:
                expected = [words[name][word.upper()] for word in expected]
            got = rows[name].tolist()
            finite = [g if e is not None else None for g, e in zip(got, expected)]
            self.assertEqual(finite, expected, f"{what}: {name}")
            for number, expects in zip(got, expected):
                self.assertEqual(expects is None, not np.isfinite(number), f"{what}: {name}")

    def assert_motion(self, motion, line, what):
        self.assertEqual(motion.dt, line["dt_s"], what)
        self.assertEqual(motion.rotation.ravel().tolist(), line["R_cur_prev"], what)
        self.assertEqual(motion.velocity.tolist(), line["v_C_mps"], what)
        self.assertEqual(motion.angular_velocity.tolist(), line["w_C_radps"], what)
        self.assertEqual(motion.up.tolist(), line["up_C"], what)
        self.assertEqual(motion.height, line["height_m"], what)

    def assert_layers(self, frame, result, line):
        what = f"frame {frame.index}"
        self.assertEqual(frame.time_ns, line["t_ns"], what)
        self.assertEqual(frame.corners[:, 0].tolist(), line["corners"]["x"], what)
        self.assertEqual(frame.corners[:, 1].tolist(), line["corners"]["y"], what)
        self.assertEqual(frame.signatures.tobytes().hex(), line["signatures"], what)
        self.assert_motion(frame.motion, line["told_motion"], what)
        verdicts = [lcs.Verdict(verdict).name.lower() for verdict in result.verdicts]
        self.assertEqual(verdicts, line["corners"]["verdict"], what)
        reasons = [lcs.Reason(reason).name.lower() for reason in result.reasons]
        self.assertEqual(reasons, line["corners"]["reason"], what)
        np.testing.assert_allclose(result.log_odds, line["log_odds"], rtol=0, atol=0.00501, err_msg=what)
        for items, normal, rebel in [
            (result.edges, "normal_edges", "rebel_edges"),
            (result.circles, "normal_circles", "rebel_circles"),
        ]:
            self.assert_columns(items[~items["rebel"]], line[normal], f"{what}, {normal}")
            self.assert_columns(items[items["rebel"]], line[rebel], f"{what}, {rebel}")
        outlines = line["squares"].pop("outline")
        self.assertEqual([outline.tolist() for outline in result.outlines], outlines, what)
        self.assert_columns(result.squares, line["squares"], f"{what}, squares")
        self.assert_columns(result.collectors, line["collectors"], f"{what}, collectors")

    def assert_truth(self, frame, line):
        what = f"truth of frame {frame.index}"
        self.assert_motion(frame.truth.motion, line["true_motion"], what)
        self.assert_columns(frame.truth.corners, line["corners"], what)
        words = line["objects"].pop("mask")
        self.assert_columns(frame.truth.objects, line["objects"], what)
        for row, word in zip(frame.truth.objects, words):
            ids = frame.truth.object_ids
            mask = ids[row["top"] : row["bottom"], row["left"] : row["right"]] == row["object"]
            self.assertEqual(decoded(word, mask.shape).tolist(), mask.tolist(), what)

    def assert_same(self, scenario_file):
        out = self.run_program(scenario_file)
        layers, truth = lines_of(out / "layers.jsonl"), lines_of(out / "truth.jsonl")[1:]
        scenario = lcs.Scenario(scenario_file, set=SETTINGS, seed=SEED)
        lcs_filter = lcs.Filter(scenario)
        frames = []

        def said():
            for frame in lcs.simulate(scenario):
                result = lcs_filter.step(frame.corners, frame.motion, frame.signatures, picture=frame.grey)
                self.assert_layers(frame, result, layers[frame.index])
                self.assert_truth(frame, truth[frame.index])
                frames.append(frame.index)
                yield frame, result

        metrics = lcs.score(said())
        self.assertEqual(frames, list(range(SETTINGS["frames"])))
        expected = json.loads((out / "metrics.json").read_text())
        self.assertEqual(list(metrics), list(expected))
        for name, figure in expected.items():
            if is_of_times(name):
                self.assertEqual(metrics[name] is None, figure is None, name)
            else:
                self.assertEqual(metrics[name], figure, name)
        self.assertGreater(metrics["truth.rebel_corners"], 0)
        self.assertGreater(metrics["time.filter_ms_median"], 0)

    def test_of_the_filter_by_day(self):
        self.assert_same(lcs.SCENARIOS / "crossing.yaml")

    def test_of_the_filter_by_night_in_rain(self):
        self.assert_same(lcs.SCENARIOS / "suite" / "night_rain.yaml")

    def test_of_somebodys_detector(self):
        """By the arrays, and by a file as DETECTIONS.md has it: the same figures."""
        scenario_file = lcs.SCENARIOS / "suite" / "crossing_near.yaml"
        out = self.run_program(scenario_file)
        detections = out.parent / "own.csv"
        with open(detections, "w", newline="") as file:
            table = csv.writer(file)

            def said():
                for frame in lcs.simulate(lcs.Scenario(scenario_file, set=SETTINGS, seed=SEED)):
                    rebels = frame.truth.labels == lcs.Label.REBEL
                    rebels[::3] ^= True
                    boxes = np.array([[250, 180.5, 330, 300], [331, 100, 420, 290.25]])
                    circles = [[300, 240, 30]] if frame.index % 2 else []
                    for corner in np.flatnonzero(rebels):
                        table.writerow([frame.index, "rebel", corner])
                    for row, (left, top, right, bottom) in enumerate(boxes):
                        place = [left, top, right - left, bottom - top]
                        table.writerow([frame.index, "box", row + 5, *place])
                    for circle in circles:
                        table.writerow([frame.index, "circle", *circle])
                    yield frame, lcs.Detections(rebels, boxes=boxes, ids=[5, 6], circles=circles)

            metrics = lcs.score(said())
        figures = out.parent / "own.json"
        self.program("score", out, "--detections", detections, "--quiet", "--out", figures)
        self.assertEqual(metrics, json.loads(figures.read_text()))
        self.assertGreater(metrics["rebel.recall"], 0)
        self.assertIsNone(metrics["time.filter_ms_median"])
        self.assertIsNone(metrics["dimension.mean"])

    def test_of_a_detector_that_gives_masks(self):
        """By the arrays, and by a file with runs down the columns of the whole picture."""
        scenario_file = lcs.SCENARIOS / "suite" / "crossing_near.yaml"
        out = self.run_program(scenario_file)
        detections = out.parent / "masks.csv"
        with open(detections, "w", newline="") as file:
            table = csv.writer(file)
            table.writerow([0, "circle"])  # no circles

            def said():
                for frame in lcs.simulate(lcs.Scenario(scenario_file, set=SETTINGS, seed=SEED)):
                    ids = frame.truth.objects["object"].tolist()
                    masks = np.array([frame.truth.object_ids == object_id for object_id in ids])
                    masks[:, :, ::4] = False  # every fourth column is hidden
                    seen = masks.any(axis=(1, 2))
                    masks, ids = masks[seen], np.array(ids)[seen]
                    for object_id, mask in zip(ids, masks):
                        pixels = mask.ravel(order="F")
                        ends = np.flatnonzero(np.diff(pixels, prepend=False)).tolist()
                        runs = np.diff([0, *ends, pixels.size])
                        table.writerow([frame.index, "mask", object_id, *mask.shape, *runs])
                    yield frame, lcs.Detections(masks=masks, ids=ids)

            metrics = lcs.score(said())
        figures = out.parent / "masks.json"
        self.program("score", out, "--detections", detections, "--quiet", "--out", figures)
        self.assertEqual(metrics, json.loads(figures.read_text()))
        self.assertIsNotNone(metrics["mover.region_j"])
        self.assertGreater(metrics["square.mean_iou"], 0.9)

    def test_of_pictures_and_readings_one_by_one(self):
        """As of a robot whose camera has a clock of its own; readings may come earlier than needed."""
        sequence, out = (Path(self.folder.name) / name for name in ("drive", "live"))
        sets = [f"--set={each}" for each in ("camera.time_offset=4 ms", "frames=15", "camera.rate=30 Hz")]
        self.program("generate", lcs.SCENARIOS / "crossing.yaml", *sets, "--formats", "euroc", "--quiet", "--out",
                     sequence)
        self.program("replay", sequence, "--no-video", "--quiet", "--out", out)
        layers = lines_of(out / "layers.jsonl")
        with open(sequence / "mav0/imu0/data.csv", newline="") as file:
            imu = [(int(t), [float(x) for x in row]) for t, *row in list(csv.reader(file))[1:]]
        with open(sequence / "mav0/odometry0/data.csv", newline="") as file:
            wheels = [(int(t), [float(x) for x in row]) for t, *row in list(csv.reader(file))[1:]]
        with open(sequence / "mav0/cam0/data.csv", newline="") as file:
            times = [int(row[0]) for row in list(csv.reader(file))[1:]]
        live = lcs.Live(sequence / "lcs.json")
        lcs_filter = lcs.Filter(live.scenario)
        recording = lcs.Scenario.from_yaml(f"recording: {{path: {sequence}}}")
        seen, ahead_ns = 0, 30_000_000
        for t, stored in zip(times, lcs.simulate(recording)):
            while imu and imu[0][0] <= t + ahead_ns:
                t_imu, row = imu.pop(0)
                live.add_imu(t_imu, row[:3], row[3:])
            while wheels and wheels[0][0] <= t + ahead_ns:
                t_wheels, row = wheels.pop(0)
                live.add_odometry(t_wheels, row[:3], row[3])
            frame = live.frame(t, stored.picture)
            result = lcs_filter.step(frame.corners, frame.motion, frame.signatures, picture=frame.grey)
            self.assert_layers(frame, result, layers[frame.index])
            seen += 1
        self.assertEqual(seen, 15)
        self.assertEqual(live.diagnostics, [])

    def test_of_two_that_take_turns(self):
        """Worlds that are open at once do not disturb each other."""
        scenarios = [
            lcs.Scenario(lcs.SCENARIOS / name, set={"frames": 3}, seed=SEED)
            for name in ("crossing.yaml", "suite/dusk.yaml")
        ]
        alone = [[frame.picture for frame in lcs.simulate(scenario)] for scenario in scenarios]
        together = zip(*map(lcs.simulate, scenarios))
        for index, frames in enumerate(together):
            for frame, pictures in zip(frames, alone):
                self.assertTrue((frame.picture == pictures[index]).all())
        self.assertEqual(index, 2)


if __name__ == "__main__":
    unittest.main()
