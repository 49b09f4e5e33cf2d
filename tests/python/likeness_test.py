"""tests/worlds/likeness.py on recordings of drawn pictures, of which the motion is known."""

import contextlib
import csv
import importlib.util
import io
import os
import sys
import tempfile
import unittest
from pathlib import Path

import lcs  # before cv2, as in the tool
import numpy as np

try:
    import cv2
except ImportError:
    print("SKIPPED: python3-opencv is missing")
    sys.exit(77)

ROOT = Path(__file__).resolve().parents[2]
spec = importlib.util.spec_from_file_location("likeness", ROOT / "tests" / "worlds" / "likeness.py")
likeness = importlib.util.module_from_spec(spec)
spec.loader.exec_module(likeness)

WIDTH, HEIGHT = 320, 240


def squares(shift=(0, 0), scale=1.0, noise=0.0, seed=0):
    """Grey squares on grey under a flat sky; smooth enough for optical flow."""
    random = np.random.default_rng(5)
    picture = np.full((HEIGHT, WIDTH), 120, np.uint8)
    for _ in range(220):
        x, y, side, grey = random.uniform((-40, -40, 6, 40), (360, 280, 20, 210))
        corners = np.array([[x, y], [x + side, y + side]]) + shift
        centre = np.array([WIDTH - 1, HEIGHT - 1]) / 2
        corners = np.rint((centre + scale * (corners - centre)) * 16).astype(int)
        cv2.rectangle(picture, corners[0].tolist(), corners[1].tolist(), float(grey), cv2.FILLED, cv2.LINE_AA, 4)
    picture[:60] = 150
    if noise:
        picture = np.clip(np.rint(picture + np.random.default_rng(seed).normal(0, noise, picture.shape)), 0, 255)
    return picture.astype(np.uint8)


def dots():
    picture = np.full((HEIGHT, WIDTH), 100, np.uint8)
    picture[10::20, 10::20] = 170
    return picture


class Likeness(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def record(self, name, pictures):
        os.mkdir(name)
        for i, picture in enumerate(pictures):
            cv2.imwrite(f"{name}/{i}.png", picture)
        keys = f"path: {name}, focal: 300 px, fps: 10, speed: 0 m/s"
        Path(f"{name}.yaml").write_text(f"recording: {{{keys}}}\ncorners: {{threshold: 20}}\n")

    def run_tool(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = likeness.main([*arguments])
        return code, out.getvalue(), err.getvalue()

    def measured(self, *pictures):
        """The measures of the first pair, as numbers."""
        self.record("run", pictures)
        code, _, err = self.run_tool("run=run.yaml")
        self.assertEqual(code, 0, err)
        with open("likeness.csv", newline="") as file:
            row = next(csv.DictReader(file))
        return {name: float(row[name]) for name in likeness.MEASURES if row[name]}

    def test_a_shift_gives_its_length_and_direction(self):
        values = self.measured(squares(), squares((4.5, 7.25)))
        self.assertAlmostEqual(values["motion_px"], np.hypot(4.5, 7.25), delta=0.1)
        self.assertAlmostEqual(values["direction_deg"], np.degrees(np.arctan2(7.25, 4.5)), delta=1)
        self.assertGreater(values["one_way"], 0.95)
        self.assertGreater(values["followed"], 0.6)

    def test_growth_goes_outward_and_not_one_way(self):
        values = self.measured(squares(), squares(scale=1.05))
        self.assertGreater(values["outward"], 0.85)
        self.assertLess(values["one_way"], 0.5)  # the sky has no corners

    def test_a_repeated_picture_is_found_again(self):
        values = self.measured(squares(), squares())
        self.assertEqual((values["found_again"], values["followed"], values["noise"]), (1, 1, 0))
        self.assertNotIn("direction_deg", values)
        self.assertLess(values["by_chance"], 0.5)

    def test_noise_is_measured_and_takes_corners_away(self):
        values = self.measured(squares(noise=8, seed=1), squares(noise=8, seed=2))
        self.assertAlmostEqual(values["noise"], 8, delta=0.8)
        self.assertLess(values["found_again"], 0.9)
        self.assertGreater(values["found_again"], values["by_chance"])

    def test_spacing_and_contrast_are_those_of_a_grid_of_dots(self):
        values = self.measured(dots(), dots())
        self.assertEqual((values["corners"], values["spacing_px"], values["contrast"]), (16 * 12, 20, 69))

    def test_a_bare_picture_has_no_measures_of_corners(self):
        bare = np.full((HEIGHT, WIDTH), 100, np.uint8)
        self.assertEqual(self.measured(bare, bare), {"corners": 0, "corners_per_mpx": 0, "noise": 0})

    def test_groups_are_compared_with_the_first_one(self):
        self.record("dots", [dots()] * 9)
        self.record("moves", [squares((i, 0)) for i in range(4)])
        code, out, err = self.run_tool("dots=dots.yaml", "moves=moves.yaml", "--pairs", "5", "--out", "rows.csv")
        self.assertEqual(code, 0, err)
        with open("rows.csv", newline="") as file:
            rows = [(row["group"], row["run"], int(row["frame"])) for row in csv.DictReader(file)]
        self.assertEqual(rows, [("dots", "dots", frame) for frame in (0, 2, 4, 5, 7)]
                         + [("moves", "moves", frame) for frame in (0, 1, 2)])  # fmt: skip
        self.assertRegex(out, r"motion_px +0 \(0 to 0\) +\*(1|0\.99)")

    def test_a_simulated_scenario_is_measured(self):
        Path("worlds").mkdir()
        Path("worlds/one.yaml").write_text(
            "scene: lab\nframes: 3\ncamera: {size: [320, 240]}\nego: {start: [-4 m, 0 m], speed: 0.5 m/s}\n"
        )
        code, out, err = self.run_tool("worlds=worlds")
        self.assertEqual(code, 0, err)
        self.assertRegex(out, r"\nmotion_px +\d")

    def test_mistakes_are_refused_in_one_line_and_nothing_is_written(self):
        self.record("one", [squares()])
        Path("empty").mkdir()
        Path("kept.csv").write_text("mine\n")
        for said, *arguments in [
            ("'one.yaml' is no group; give NAME=PATH", "one.yaml"),
            ("missing.yaml", "a=missing.yaml"),
            ("empty has no scenario files", "a=empty"),
            ("one.yaml has no two neighbouring pictures", "a=one.yaml"),
            ("kept.csv exists", "a=one.yaml", "--out", "kept.csv"),
        ]:
            code, out, err = self.run_tool(*arguments)
            self.assertEqual((code, out, err.count("\n")), (2, "", 1), err)
            self.assertIn(said, err)
        self.assertEqual(Path("kept.csv").read_text(), "mine\n")
        self.assertFalse(Path("likeness.csv").exists())


if __name__ == "__main__":
    unittest.main()
