"""What the package promises beyond its figures: arrays that stay, errors in words, and no crash."""

import ast
import copy
import enum
import gc
import itertools
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

import lcs

CROSSING = lcs.SCENARIOS / "crossing.yaml"
TEXT = """
scene: lab
frames: 4
camera: {size: [320, 240]}
ego: {start: [-4 m, 0 m], speed: 0.5 m/s}
"""


def small(**set_):
    return lcs.Scenario.from_yaml(TEXT, set=set_)


class Scenarios(unittest.TestCase):
    def test_says_what_it_is(self):
        scenario = lcs.Scenario(CROSSING, set={"camera.rate": "5 Hz", "frames": 7}, seed=9)
        self.assertEqual((scenario.name, scenario.frames, scenario.seed), ("crossing", 7, 9))
        self.assertFalse(scenario.recorded)
        self.assertIn("short", scenario.groups)
        camera = scenario.camera
        self.assertEqual((camera.width, camera.height, camera.rate), (640, 480, 5))
        self.assertEqual((camera.cx, camera.cy), (319.5, 239.5))
        self.assertAlmostEqual(camera.fy, 240 / np.tan(np.pi / 6))
        np.testing.assert_array_equal(
            camera.matrix, [[camera.fx, 0, 319.5], [0, camera.fy, 239.5], [0, 0, 1]]
        )

    def test_takes_numbers_as_text(self):
        for speed in ("0.7 m/s", "0.7", 0.7, np.float64(0.7), np.float32(0.5)):
            lcs.Scenario(CROSSING, set={"ego.speed": speed, "frames": np.int64(3)})
        self.assertEqual(lcs.Scenario(str(CROSSING), seed=np.uint64(2**63)).seed, 2**63)

    def test_runs_from_any_folder(self):
        code = (
            "import lcs; s = lcs.Scenario(lcs.SCENARIOS / 'examples' / 'warehouse' / 'warehouse.yaml',"
            " set={'frames': 1}); print(next(lcs.simulate(s)).corners.shape[0] > 0)"
        )
        with tempfile.TemporaryDirectory() as elsewhere:
            path = os.pathsep.join(map(os.path.abspath, filter(None, sys.path)))
            done = subprocess.run(
                [sys.executable, "-c", code],
                cwd=elsewhere,
                env={**os.environ, "PYTHONPATH": path},
                capture_output=True,
                text=True,
            )
        self.assertEqual((done.stdout, done.stderr), ("True\n", ""))

    def test_refuses_as_the_program_does(self):
        def refusal(*arguments, **settings):
            with self.assertRaises(lcs.Error) as raised:
                lcs.Scenario(*arguments, **settings)
            return str(raised.exception)

        self.assertEqual(
            refusal("nowhere.yaml"),
            "nowhere.yaml: there is no such file; give the path of a scenario file (.yaml)",
        )
        self.assertEqual(
            refusal(CROSSING, set={"ego.sped": 1}),
            "--set ego.sped=1: unknown key 'sped' in ego; did you mean 'speed'?",
        )
        self.assertIn("is an angle", refusal(CROSSING, set={"ego.speed": "9 deg"}))
        self.assertIn("circle.gap", refusal(CROSSING, set={"filter.circle.gap0": 3}))
        self.assertIn("the seed", refusal(CROSSING, seed=-1))
        self.assertIn("the seed", refusal(CROSSING, seed="many"))
        self.assertIn("there is no scene 'moon'", refusal(CROSSING, set={"scene": "moon"}))
        with self.assertRaises(lcs.Error) as raised:
            lcs.Scenario.from_yaml("scene: lab\nframes: many\n", file="mine.yaml")
        self.assertTrue(str(raised.exception).startswith("mine.yaml:2: "), raised.exception)
        for text, told in (("", "scenario.yaml: the file is empty"), ("[1]", "scenario.yaml:1: a scenario is a map")):
            with self.assertRaisesRegex(lcs.Error, told):
                lcs.Scenario.from_yaml(text)

    def test_refuses_what_is_no_setting(self):
        for settings in ({"ego.start": [1, 2]}, {3: 4}, "ego.speed=1", {"ego.speed": None}):
            with self.assertRaises(TypeError, msg=settings):
                lcs.Scenario(CROSSING, set=settings)
        with self.assertRaises(TypeError):
            lcs.Scenario(3)

    def test_refuses_parameters_of_another_preset(self):
        with self.assertRaisesRegex(lcs.Error, "which is of lab, cars"):
            lcs.Scenario(CROSSING, set={"filter.circle.alpha_reach": 3})


class Frames(unittest.TestCase):
    def test_arrays_have_the_shapes_that_they_are_said_to_have(self):
        frame = list(lcs.simulate(lcs.Scenario(CROSSING, set={"frames": 2})))[1]
        n = len(frame.corners)
        self.assertGreater(n, 100)
        truth = frame.truth
        shapes = {
            "picture": (frame.picture, (480, 640, 3), np.uint8),
            "grey": (frame.grey, (480, 640), np.uint8),
            "corners": (frame.corners, (n, 2), np.float64),
            "signatures": (frame.signatures, (n, 32), np.uint8),
            "rotation": (frame.motion.rotation, (3, 3), np.float64),
            "velocity": (frame.motion.velocity, (3,), np.float64),
            "labels": (truth.labels, (n,), np.uint8),
            "boxes": (truth.boxes, (len(truth.objects), 4), np.float64),
            "depth": (truth.depth, (480, 640), np.float32),
            "object_ids": (truth.object_ids, (480, 640), np.int32),
            "T_WC": (truth.T_WC, (4, 4), np.float64),
            "T_WO": (truth.T_WO, (len(truth.names) + 1, 4, 4), np.float64),
        }
        for name, (array, shape, dtype) in shapes.items():
            self.assertEqual((array.shape, array.dtype), (shape, dtype), name)
            with self.assertRaises(ValueError, msg=name):
                array[...] = 0
        self.assertEqual((frame.index, frame.time, frame.time_ns), (1, 0.1, 100_000_000))
        np.testing.assert_allclose(frame.imu["t"], np.arange(1, 21) * 0.005)
        self.assertEqual(frame.imu["accel"].shape, (20, 3))
        np.testing.assert_allclose(frame.imu["accel"].mean(axis=0), [0, 0, 9.81], atol=0.1)
        np.testing.assert_allclose(frame.odometry["velocity"].mean(axis=0), [0.5, 0, 0], atol=0.05)
        np.testing.assert_allclose(frame.odometry["yaw_rate"].mean(), 0, atol=0.1)
        self.assertEqual(len(truth.corners), n)
        np.testing.assert_array_equal(truth.corners["label"], truth.labels)

    def test_the_truth_fits_together(self):
        """A corner's object is what the pixels show there, and the poses are those of the motion."""
        before, frame = list(lcs.simulate(lcs.Scenario(CROSSING, set={"frames": 2})))
        truth = frame.truth
        x, y = frame.corners.astype(int).T
        near = [truth.object_ids[y + dy, x + dx] for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        self.assertTrue((np.array(near) == truth.corners["object"]).any(axis=0).all())
        left, top, right, bottom = truth.boxes[0].astype(int)
        rows, columns = np.nonzero(truth.object_ids == truth.objects["object"][0])
        self.assertEqual((left, right), (columns.min(), columns.max() + 1))
        self.assertEqual((top, bottom), (rows.min(), rows.max() + 1))
        again = lcs.Motion.between(before.truth.T_WC, truth.T_WC, truth.motion.dt)
        np.testing.assert_array_equal(again.rotation, truth.motion.rotation)
        np.testing.assert_array_equal(again.velocity, truth.motion.velocity)
        np.testing.assert_array_equal(truth.of(frame.corners), truth.corners)
        outside = [[-5, 3], [3, 1e30], [np.inf, 3], [3, np.nan], [-(2.0**32), 2.0**40]]
        self.assertEqual(truth.of(outside)["label"].tolist(), [lcs.Label.NONE] * 5)
        with self.assertRaises(ValueError):
            truth.of([1, 2, 3])
        self.assertFalse(before.motion.usable)
        self.assertTrue(frame.motion.usable)

    def test_arrays_outlive_frame_and_simulation(self):
        simulation = lcs.simulate(small())
        first = next(simulation)
        arrays = [
            first.picture, first.grey, first.signatures, first.truth.depth, first.truth.object_ids,
            first.corners, first.imu, first.truth.corners, first.truth.T_WC,
        ]  # fmt: skip
        copies = [array.copy() for array in arrays]
        result = lcs.Filter(small()).step(first.corners, first.motion)
        verdicts = result.verdicts
        pending = verdicts.copy()
        del first, result
        for _ in simulation:
            gc.collect()
        del simulation
        gc.collect()
        trash = [np.full((240, 320, 3), 255, np.uint8) for _ in range(20)]
        for array, copy in zip(arrays, copies):
            np.testing.assert_array_equal(array, copy)
        np.testing.assert_array_equal(verdicts, pending)
        self.assertEqual(len(trash), 20)

    def test_ends_once_and_for_all(self):
        simulation = lcs.simulate(small())
        self.assertEqual([frame.index for frame in simulation], [0, 1, 2, 3])
        for _ in range(2):
            with self.assertRaises(StopIteration):
                next(simulation)
        self.assertEqual(simulation.warnings, [])

    def test_is_of_one_thread(self):
        simulation = lcs.simulate(small())
        raised = []

        def elsewhere():
            try:
                next(simulation)
            except lcs.Error as error:
                raised.append(str(error))

        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
        self.assertIn("another thread", raised[0])
        self.assertEqual(len(list(simulation)), 4)

    def test_threads_have_one_each_and_the_same_bits(self):
        expected = [frame.picture.tobytes() for frame in lcs.simulate(small())]
        seen = {}

        def run(name):
            seen[name] = [frame.picture.tobytes() for frame in lcs.simulate(small())]

        threads = [threading.Thread(target=run, args=(name,)) for name in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([seen[name] == expected for name in range(3)], [True] * 3)

    def test_dropped_by_another_thread(self):
        box = [lcs.simulate(small())]
        next(box[0])
        thread = threading.Thread(target=box.clear)
        thread.start()
        thread.join()
        gc.collect()
        self.assertEqual(len(list(lcs.simulate(small()))), 4)

    def test_ctrl_c_ends_it_between_two_frames(self):
        code = (
            "import lcs, sys\n"
            "s = lcs.Scenario(lcs.SCENARIOS / 'crossing.yaml', set={'frames': 100000})\n"
            "simulation = lcs.simulate(s)\n"
            "print(next(simulation).index, flush=True)\n"
            "try:\n"
            "    list(f.index for f in simulation) if sys.argv[1] == 'loop' else max(map(id, simulation))\n"
            "except KeyboardInterrupt:\n"
            "    print('goes on at', next(simulation).index > 0)\n"
        )
        for kind in ("loop", "in C"):
            child = subprocess.Popen(
                [sys.executable, "-c", code, kind],
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            self.assertEqual(child.stdout.readline(), "0\n")
            time.sleep(0.3)
            child.send_signal(signal.SIGINT)
            out, err = child.communicate(timeout=60)
            self.assertEqual((out, err, child.returncode), ("goes on at True\n", "", 0))

    def test_a_fork_is_told_that_it_cannot_go_on(self):
        simulation = lcs.simulate(small())
        next(simulation)
        told = []
        for attempt in (lambda: next(simulation), lambda: lcs.simulate(small())):
            read_end, write_end = os.pipe()
            child = os.fork()
            if child == 0:
                try:
                    attempt()
                except BaseException as error:
                    os.write(write_end, repr(error).encode())
                os._exit(0)
            os.close(write_end)
            os.waitpid(child, 0)
            with os.fdopen(read_end) as pipe:
                told.append(pipe.read())
        for text in told:
            self.assertRegex(text, "^Error.*spawn")
        self.assertEqual(len(list(simulation)), 3)

    def test_impossible_simulations_are_refused(self):
        with self.assertRaisesRegex(lcs.Error, "moves body 'ghost', which the scene lacks"):
            lcs.simulate(small(**{"actors.ghost.body": "ghost", "actors.ghost.trajectory.line.speed": 1}))
        for nothing in (CROSSING, None):
            with self.assertRaises(TypeError):
                lcs.simulate(nothing)


class Recorded(unittest.TestCase):
    def test_frames_of_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            frames = list(lcs.simulate(lcs.Scenario(CROSSING, set={"frames": 5})))
            for frame in frames:
                rgb = frame.picture[..., ::-1].tobytes()
                Path(folder, f"{frame.index:03}.ppm").write_bytes(b"P6 640 480 255\n" + rgb)
            text = f"recording: {{path: {folder}, fps: 10, focal: 415.7 px, speed: 0.5 m/s, nothing_moves: true}}"
            scenario = lcs.Scenario.from_yaml(text, file="played.yaml", set={"corners.threshold": 20})
            self.assertTrue(scenario.recorded)
            self.assertEqual((scenario.frames, scenario.camera.fx, scenario.camera.rate), (5, 415.7, 10))
            played = list(lcs.simulate(scenario))
            self.assertEqual(len(played), 5)
            for frame, again in zip(frames, played):
                np.testing.assert_array_equal(frame.picture, again.picture)
                np.testing.assert_array_equal(frame.corners, again.corners)
                self.assertTrue((again.truth.labels == lcs.Label.FIXED).all())
                self.assertEqual((len(again.imu), len(again.truth.objects)), (0, 0))
                for name in ("motion", "depth", "object_ids", "T_WC", "T_WO"):
                    with self.assertRaisesRegex(ValueError, "recorded"):
                        getattr(again.truth, name)
                with self.assertRaisesRegex(ValueError, "recorded"):
                    again.truth.of(again.corners)
            metrics = lcs.score((frame, np.zeros(len(frame.corners), bool)) for frame in played)
            self.assertEqual(metrics["rebel.false_corners_per_frame"], 0)
            self.assertIsNone(metrics["truth.boxes"])


class Lives(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        size = {"camera.size": "[320, 240]"}
        lcs.generate(CROSSING, set=size, frames=1, formats=["euroc"], out=folder.name + "/drive")
        cls.settings = Path(folder.name) / "drive/lcs.json"

    def test_frames_are_numbered_and_begin_at_0(self):
        live, picture = lcs.Live(self.settings), np.zeros((240, 320, 3), np.uint8)
        frames = [live.frame(t, picture) for t in (5 * 10**9, 6 * 10**9)]
        self.assertEqual([(frame.index, frame.time_ns) for frame in frames], [(0, 0), (1, 10**9)])
        self.assertEqual(len(frames[1].imu), 0)
        with self.assertRaises(ValueError):
            frames[0].truth.depth

    def test_a_reading_of_each_sensor_makes_a_picture_due(self):
        live = lcs.Live(self.settings)
        live.add_imu(10**9, [0, 0, 0], [0, 0, 9.81])
        self.assertFalse(live.is_due(10**9))
        live.add_odometry(10**9, [0.5, 0, 0], 0.1)
        self.assertTrue(live.is_due(10**9))
        self.assertFalse(live.is_due(10**9 + 1))

    def test_refuses_what_goes_back_and_pictures_of_another_camera(self):
        live, picture = lcs.Live(self.settings), np.zeros((240, 320, 3), np.uint8)
        live.frame(10**9, picture)
        live.add_imu(10**9, [0, 0, 0], [0, 0, 9.81])
        live.add_odometry(10**9, [0, 0, 0])
        for again in (
            lambda: live.frame(10**9, picture),
            lambda: live.add_imu(10**9, [0, 0, 0], [0, 0, 9.81]),
            lambda: live.add_odometry(10**9 - 1, [0, 0, 0]),
        ):
            with self.assertRaisesRegex(ValueError, "the time goes back from 1000000000 to .* ns; begin anew"):
                again()
        with self.assertRaisesRegex(ValueError, "no time|one since 1970"):
            live.frame(2**62, picture)
        with self.assertRaisesRegex(ValueError, "the picture has 160 x 240 pixels, and the settings say 320 x 240"):
            live.frame(2 * 10**9, picture[:, :160])
        with self.assertRaisesRegex(ValueError, "height x width x 3"):
            live.frame(2 * 10**9, picture[..., 0])
        with self.assertRaisesRegex(TypeError, "height x width x 3"):
            live.frame(2 * 10**9, picture.astype(float))
        self.assertEqual(live.frame(2 * 10**9, picture).index, 1)

    def test_refuses_settings_that_are_none(self):
        with self.assertRaisesRegex(lcs.Error, "nothing.json"):
            lcs.Live("nothing.json")
        told = self.settings.with_name("truth.json")
        told.write_text(self.settings.read_text().replace('"ego_motion": "imu"', '"ego_motion": "truth"'))
        with self.assertRaisesRegex(lcs.Error, "ego_motion is truth, which a robot does not have; make it imu"):
            lcs.Live(told)


class Motions(unittest.TestCase):
    def test_says_whether_it_is_of_use(self):
        self.assertTrue(lcs.Motion(dt=0.1, velocity=[0, 0, 1]).usable)
        for bad in (
            {"dt": 0}, {"dt": -1}, {"dt": 100}, {"dt": np.nan}, {"dt": 0.1, "velocity": [np.inf, 0, 0]},
            {"dt": 0.1, "rotation": np.ones((3, 3))},
        ):  # fmt: skip
            self.assertFalse(lcs.Motion(**bad).usable, bad)

    def test_has_the_rate_of_its_rotation(self):
        c, s = np.cos(0.02), np.sin(0.02)
        motion = lcs.Motion(dt=0.1, rotation=[[c, 0, s], [0, 1, 0], [-s, 0, c]], velocity=(1, 2, 3))
        np.testing.assert_allclose(motion.angular_velocity, [0, -0.2, 0], atol=1e-12)
        np.testing.assert_allclose(motion.displacement, [0.1, 0.2, 0.3])
        self.assertIsNone(motion.up)
        self.assertEqual(lcs.Motion(dt=1, up=[0, -1, 0], height=0.5).height, 0.5)

    def test_refuses_what_is_none(self):
        for error, bad in (
            (ValueError, {"dt": 1, "rotation": np.eye(4)}),
            (ValueError, {"dt": 1, "velocity": [1, 2]}),
            (ValueError, {"dt": 1, "velocity": [[1, 2, 3]]}),
            (ValueError, {"dt": 1, "height": 0.5}),
            (ValueError, {"dt": 1, "up": [0, -1, 0]}),
            (TypeError, {"dt": 1, "velocity": "fast"}),
            (TypeError, {"dt": 1, "velocity": [1j, 0, 0]}),
            (TypeError, {"dt": "soon"}),
            (TypeError, {}),
        ):
            with self.assertRaises(error, msg=bad):
                lcs.Motion(**bad)
        with self.assertRaisesRegex(ValueError, "above 0"):
            lcs.Motion.between(np.eye(4), np.eye(4), 0)
        with self.assertRaisesRegex(ValueError, "T_WC_now"):
            lcs.Motion.between(np.eye(4), np.eye(3), 1)


class Filters(unittest.TestCase):
    def setUp(self):
        self.camera = lcs.Camera(focal=400, cx=159.5, cy=119.5, width=320, height=240)
        self.motion = lcs.Motion(dt=0.1, velocity=[0, 0, 0.5])

    def test_takes_whatever_is_an_array_of_numbers(self):
        corners = [[10, 20], [30.5, 40]]
        for given in (corners, np.array(corners), np.array(corners, np.float32), np.array(corners)[::-1],
                      np.array(corners, order="F"), [], np.zeros((0, 2)), np.array([[1, 2]], np.uint16)):  # fmt: skip
            result = lcs.Filter(self.camera).step(given, self.motion)
            self.assertEqual(len(result.verdicts), len(given))
            self.assertEqual(result.verdicts.dtype, np.uint8)

    def test_order_in_memory_does_not_matter(self):
        corners = np.random.default_rng(1).uniform(0, 239, (50, 2))
        rows = lcs.Filter(self.camera).step(corners, self.motion)
        columns = lcs.Filter(self.camera).step(np.asfortranarray(corners), self.motion)
        np.testing.assert_array_equal(rows.edges["x"], columns.edges["x"])

    def test_refuses_what_is_none_and_goes_on(self):
        fine, signatures = [[10, 20], [30, 40]], np.zeros((2, 32), np.uint8)
        lcs_filter = lcs.Filter(self.camera)
        for error, arguments in (
            (ValueError, ([[1, 2, 3]], self.motion)),
            (ValueError, ([1, 2], self.motion)),
            (ValueError, (np.zeros((2, 2, 2)), self.motion)),
            (ValueError, (np.float64(3), self.motion)),
            (TypeError, (["a", "b"], self.motion)),
            (TypeError, ([[1, 2], [3]], self.motion)),
            (TypeError, (np.array(fine, complex), self.motion)),
            (TypeError, (np.array(fine, object), self.motion)),
            (TypeError, (np.array(fine, bool), self.motion)),
            (TypeError, (None, self.motion)),
            (TypeError, (fine, None)),
            (TypeError, (fine, 0.1)),
            (TypeError, (fine,)),
            (ValueError, (fine, self.motion, signatures[:1])),
            (ValueError, (fine, self.motion, signatures[:, :31])),
            (ValueError, (fine, self.motion, signatures[0])),
            (TypeError, (fine, self.motion, signatures.astype(np.int8))),
            (TypeError, (fine, self.motion, signatures.astype(np.uint16))),
            (TypeError, (fine, self.motion, signatures.astype(float))),
            (TypeError, (fine, self.motion, "none")),
        ):
            with self.assertRaises(error, msg=arguments):
                lcs_filter.step(*arguments)
        after, untouched = lcs_filter.step(fine, self.motion), lcs.Filter(self.camera).step(fine, self.motion)
        np.testing.assert_array_equal(after.verdicts, untouched.verdicts)
        self.assertEqual(lcs_filter.diagnostics, [])

    def test_bad_numbers_are_left_out_and_told(self):
        lcs_filter = lcs.Filter(self.camera)
        corners = [[np.nan, 3], [1e300, 3], [-4, 2], [5, 5]]
        result = lcs_filter.step(corners, lcs.Motion(dt=np.nan))
        self.assertEqual(len(result.verdicts), 4)
        self.assertEqual(lcs.Reason(result.reasons[0]), lcs.Reason.NOT_FINITE)
        self.assertTrue(any("corner_not_finite" in line for line in lcs_filter.diagnostics))

    def test_explains_its_verdicts_by_the_numbers_that_made_them(self):
        scenario = small(frames=6)
        own = lcs.Filter(scenario)
        for frame in lcs.simulate(scenario):
            result = own.step(frame.corners, frame.motion, frame.signatures)
        told = 0
        for i, odds in enumerate(result.log_odds):
            why = own.explain(i)
            if why is None:
                continue
            self.assertAlmostEqual(why["numbers"]["m"], odds, delta=1e-6)
            if "sum of k" in why["numbers"]:
                told += 1
                weights = sum(one["k"] for one in why["neighbours"])
                self.assertAlmostEqual(why["numbers"]["sum of k"], weights, delta=1e-4)
        self.assertGreater(told, 20)
        self.assertIsNone(own.explain(len(result.log_odds)))
        with self.assertRaises(ValueError):
            lcs.Filter(scenario.camera, "lab").explain(0)

    def test_settings_are_checked(self):
        for settings in ({"circle.gap0": 3}, {"circle.gap": "wide"}, {"circle.gap": -1}):
            with self.assertRaisesRegex(lcs.Error, "circle.gap"):
                lcs.Filter(self.camera, set=settings)
        with self.assertRaisesRegex(lcs.Error, "default, lab, cars"):
            lcs.Filter(self.camera, "labb")
        with self.assertRaises(ValueError):
            lcs.Filter(lcs.Camera(focal=-1, cx=0, cy=0, width=10, height=10))
        for nothing in ("crossing", None):
            with self.assertRaises(TypeError):
                lcs.Filter(nothing)
        with self.assertRaisesRegex(lcs.Error, "which is of lab, cars"):
            lcs.Filter(self.camera, set={"circle.alpha_reach": 3})
        lcs.Filter(self.camera, "lab", set={"circle.alpha_reach": 3})


class Scores(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frames = list(lcs.simulate(lcs.Scenario(CROSSING, set={"frames": 6})))
        cls.other = next(lcs.simulate(lcs.Scenario(CROSSING, set={"frames": 1})))

    def test_the_truth_itself_scores_best(self):
        def said():
            for frame in self.frames:
                truth = frame.truth
                yield frame, lcs.Detections(
                    truth.labels == lcs.Label.REBEL, boxes=truth.boxes, ids=truth.objects["object"]
                )

        metrics = lcs.score(said())
        self.assertEqual(metrics["frames"], 6)
        for name in ("rebel.f1", "square.recall_70", "square.precision_70", "square.mean_iou"):
            self.assertEqual(metrics[name], 1, name)
        self.assertEqual(metrics["square.identity_switches"], 0)
        self.assertLess(metrics["mover.region_j"], 1)  # of boxes

    def test_masks_of_the_truth_score_best_and_bad_ones_are_refused(self):
        def said():
            for frame in self.frames:
                objects = frame.truth.objects
                ids = objects["object"][objects["moving"]].tolist()
                yield frame, lcs.Detections(
                    masks=[frame.truth.object_ids == object_id for object_id in ids], ids=ids
                )

        metrics = lcs.score(said())
        for name in ("mover.hota", "mover.region_j", "mover.boundary_f", "mover.pixel_iou"):
            self.assertEqual(metrics[name], 1, name)
        whole = np.ones((1, 4, 6), bool)
        for error, arguments in [
            (ValueError, {"masks": whole}),
            (ValueError, {"masks": whole, "ids": [1, 2]}),
            (ValueError, {"masks": whole, "ids": [1], "boxes": [[0, 0, 1, 1]]}),
            (ValueError, {"masks": ~whole, "ids": [1]}),
            (ValueError, {"masks": whole[0], "ids": [1]}),
            (TypeError, {"masks": [[[0.5]]], "ids": [1]}),
        ]:
            with self.assertRaises(error, msg=str(arguments)):
                lcs.Detections(**arguments)
        lcs.Detections(masks=[], ids=[])

    def test_nothing_said_finds_nothing(self):
        metrics = lcs.score((frame, lcs.Detections()) for frame in self.frames)
        self.assertEqual((metrics["rebel.recall"], metrics["square.recall_30"]), (0, 0))
        self.assertEqual(metrics["rebel.precision"], 0)
        self.assertEqual(lcs.score([])["frames"], 0)

    def test_refused_frames_count_for_nothing(self):
        scorer = lcs.Scorer()
        frame = self.frames[0]
        n = len(frame.corners)
        fine = np.zeros(n, bool)
        result = lcs.Filter(lcs.Scenario(CROSSING)).step(frame.corners[:5], frame.motion)
        for error, arguments in (
            (ValueError, (frame, fine[:-1])),
            (ValueError, (frame, fine[None])),
            (TypeError, (frame, fine.astype(int))),
            (TypeError, (frame, "none")),
            (ValueError, (frame, result)),
            (ValueError, (self.frames[1], fine)),
            (TypeError, (None, fine)),
        ):
            with self.assertRaises(error, msg=arguments):
                scorer.add(*arguments)
        scorer.add(frame, fine)
        for error, arguments in (
            (ValueError, (frame, fine)),
            (ValueError, (self.other, fine)),
            (ValueError, (self.frames[1], lcs.Filter(lcs.Scenario(CROSSING)).step([], frame.motion))),
        ):
            with self.assertRaises(error, msg=arguments):
                scorer.add(*arguments)
        scorer.add(self.frames[1], np.zeros(len(self.frames[1].corners), bool))
        self.assertEqual(scorer.metrics()["frames"], 2)
        with self.assertRaises(TypeError):
            lcs.score(self.frames)

    def test_detections_that_are_none(self):
        for error, bad in (
            (ValueError, {"boxes": [[0, 0, 10, 10]]}),
            (ValueError, {"boxes": [[0, 0, 10]], "ids": [1]}),
            (ValueError, {"boxes": [[10, 0, 0, 10]], "ids": [1]}),
            (ValueError, {"boxes": [[0, 0, np.nan, 10]], "ids": [1]}),
            (ValueError, {"boxes": [[0, 0, 1, 1]], "ids": [1, 2]}),
            (ValueError, {"boxes": [[0, 0, 1, 1]], "ids": [-1]}),
            (ValueError, {"boxes": [[0, 0, 1, 1]] * 2, "ids": [1, 1]}),
            (TypeError, {"boxes": [[0, 0, 1, 1]], "ids": [1.5]}),
            (TypeError, {"boxes": [[0, 0, 1, 1]], "ids": 1}),
            (TypeError, {"boxes": "none"}),
            (ValueError, {"circles": [[1, 2, -3]]}),
            (ValueError, {"circles": [1, 2, 3]}),
            (TypeError, {"rebels": [0, 1]}),
        ):
            with self.assertRaises(error, msg=bad):
                lcs.Detections(**bad)


    def test_detections_are_checked_against_the_camera(self):
        frame = self.frames[0]  # of 640 x 480 pixels
        whole = np.ones((1, 480, 640), bool)
        for told, bad in (
            ("of 320 x 240 pixels, and the picture of 640 x 480", {"masks": whole[:, ::2, ::2], "ids": [1]}),
            ("of 480 x 640 pixels, and the picture of 640 x 480", {"masks": whole.transpose(0, 2, 1), "ids": [1]}),
            ("lies outside of the picture", {"boxes": [[640, 0, 650, 10]], "ids": [1]}),
            ("reaches more than 10 times", {"boxes": [[0, 0, 9000, 10]], "ids": [1]}),
            ("lies outside of the picture", {"circles": [[320, 500, 10]]}),
        ):
            scorer = lcs.Scorer()
            with self.assertRaisesRegex(ValueError, "^frame 0: .*" + told):
                scorer.add(frame, lcs.Detections(**bad))
            scorer.add(frame, lcs.Detections())  # the failed call was not counted
        lcs.Scorer().add(frame, lcs.Detections(boxes=[[-10, -10, 5, 5]], ids=[1], circles=[[320, 485, 10]]))
        lcs.Scorer().add(frame, lcs.Detections(masks=whole[:, ::-1, ::-1], ids=[1]))

    def test_absurd_arrays_are_refused_at_once(self):
        endless = []
        endless.append(endless)
        boxes = [[0, 0, 1, 1]] * 1001
        for error, bad in (
            (ValueError, {"boxes": boxes, "ids": range(1001)}),
            (ValueError, {"boxes": [[0, 0, 1, 1]], "ids": itertools.count()}),
            (ValueError, {"boxes": [[0, 0, 1, 1]], "ids": [2**53]}),
            (ValueError, {"boxes": [[0, 0, 1, 1]], "ids": np.array([2**64 - 1], np.uint64)}),
            (TypeError, {"boxes": [[0, 0, 1, 1]], "ids": [2**64]}),
            (ValueError, {"boxes": [[-1e308, 0, 1e308, 1]], "ids": [1]}),
            (ValueError, {"boxes": [[0, 0, 1e6, 1]], "ids": [1]}),
            (ValueError, {"circles": [[0, 0, 1e308]]}),
            (ValueError, {"circles": [[0, 0, np.inf]]}),
            (ValueError, {"circles": np.zeros((10001, 3))}),
            (ValueError, {"masks": itertools.repeat(np.ones((2, 2), bool)), "ids": range(2)}),
            (ValueError, {"masks": np.broadcast_to(True, (10**12, 2, 2)), "ids": itertools.count()}),
            (ValueError, {"masks": np.broadcast_to(True, (1, 2**32 + 4, 1)), "ids": [1]}),
            (ValueError, {"masks": np.broadcast_to(True, (1, 2**31, 2**31)), "ids": [1]}),
            (ValueError, {"masks": np.zeros((3, 0, 5), bool), "ids": range(3)}),
            (ValueError, {"masks": np.zeros((0, 5, 5), bool), "ids": [1]}),
            ((TypeError, ValueError), {"boxes": endless, "ids": [1]}),
            ((TypeError, ValueError), {"boxes": [[0, 0, 1, 1]], "ids": endless}),
            ((TypeError, ValueError), {"masks": endless, "ids": [1]}),
            ((TypeError, ValueError), {"rebels": endless}),
            (MemoryError, {"boxes": np.broadcast_to(1.0, (2**55, 4)), "ids": [1]}),
            (MemoryError, {"rebels": np.broadcast_to(True, (2**60,))[::-1]}),
        ):
            with self.assertRaises(error, msg=str(bad)[:200]):
                lcs.Detections(**bad)
        lcs.Detections(boxes=np.array([[0, 0, 1, 1]] * 4)[::-1, ::1][::2], ids=np.arange(4)[::-2])
        camera = lcs.Camera(focal=400, cx=159.5, cy=119.5, width=320, height=240)
        motion = lcs.Motion(dt=0.1)
        for error, corners in (
            ((TypeError, ValueError), endless),
            (MemoryError, np.broadcast_to(1.0, (2**55, 2))),
            (TypeError, np.array([[2**70, 1]], object)),
        ):
            with self.assertRaises(error):
                lcs.Filter(camera).step(corners, motion)
        for bad in ({"dt": 10**400}, {"dt": 1, "height": 10**400, "up": [0, 1, 0]}):
            with self.assertRaises((TypeError, OverflowError)):
                lcs.Motion(**bad)
        for side in (2**31, -(2**31) - 1, 10**400, 0.5):
            with self.assertRaises(TypeError):
                lcs.Camera(focal=1, cx=0, cy=0, width=side, height=10)
        for side in (0, -1):
            with self.assertRaises(ValueError):
                lcs.Filter(lcs.Camera(focal=1, cx=0, cy=0, width=side, height=side))
        wide = lcs.Filter(lcs.Camera(focal=1, cx=0, cy=0, width=2**31 - 1, height=2**31 - 1))
        for _ in range(4):
            self.assertEqual(len(wide.step([[1, 2], [2e9, 2e9]], motion).verdicts), 2)


class Values(unittest.TestCase):
    """No object lacks its value, whichever way it is made, so that none can crash."""

    CLASSES = [thing for thing in vars(lcs._core).values() if type(thing) is type(lcs.Filter)]
    WAYS = r"""
import copy, copyreg, itertools, pickle, sys
import numpy as np
import lcs

C = getattr(lcs, sys.argv[1])

def other():
    x = lcs.Scorer() if C is lcs.Motion else lcs.Motion(dt=1)
    if sys.version_info < (3, 10): raise TypeError("a class is not frozen")
    x.__class__ = C
    return x

def derived(**members):
    return type("Derived", (C,), members)

ways = {
    "__new__": lambda: C.__new__(C),
    "__new__ with arguments": lambda: C.__new__(C, 1, a=2),
    "__new__ of object": lambda: object.__new__(C),
    "__new__ of the base": lambda: C.__mro__[1].__new__(C),
    "call of type": lambda: type.__call__(C),
    "call of the metaclass's base": lambda: type(C).__mro__[1].__call__(C),
    "copyreg.__newobj__": lambda: copyreg.__newobj__(C),
    "copyreg.__newobj_ex__": lambda: copyreg.__newobj_ex__(C, (), {}),
    "copyreg of object": lambda: copyreg._reconstructor(C, object, None),
    "copyreg of the base": lambda: copyreg._reconstructor(C, C.__mro__[1], None),
    "pickle": lambda: pickle.loads(b"\x80\x02clcs\n" + sys.argv[1].encode() + b"\n)\x81."),
    "derived, without super().__init__()": lambda: derived(__init__=lambda self: None)(),
    "derived, __new__": lambda: derived().__new__(derived()),
    "another object's __class__": other,
}

def use(x):
    for name in dir(C):
        if name == "__class__": continue
        for arguments in ([], [x], [[], x]):
            try:
                value = getattr(x, name)
                value(*arguments)
            except Exception:
                pass
    repr(x), str(x), list(itertools.islice(x, 3))

for name, make in ways.items():
    try:
        x = make()
    except TypeError:
        continue
    print("made by", name, flush=True)
    use(x)
"""

    def test_the_module_has_no_other_classes(self):
        others = {"Answer", "Error", "Label", "Reason", "Verdict"}  # Python's own, and enumerations
        names = {name for name in lcs.__all__ if isinstance(getattr(lcs, name), type)}
        self.assertEqual({thing.__name__ for thing in self.CLASSES}, names - others)

    def test_no_way_leads_round_the_call(self):
        for thing in self.CLASSES:
            done = subprocess.run(
                [sys.executable, "-c", self.WAYS, thing.__name__],
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
                capture_output=True,
                text=True,
            )
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""), thing)

    def test_members_refuse_what_is_of_no_or_another_class(self):
        strangers = [None, object(), 3, lcs.Motion(dt=1), lcs.Scorer()]
        for thing in self.CLASSES:
            for name, member in vars(thing).items():
                function = member.fget if isinstance(member, property) else member
                if not callable(function) or isinstance(member, staticmethod) or name == "__new__":
                    continue
                for stranger in strangers:
                    if isinstance(stranger, thing):
                        continue
                    with self.assertRaises(TypeError, msg=(thing, name, stranger)):
                        function(stranger)

    def test_objects_are_not_copied_and_not_pickled(self):
        scenario = small()
        simulation = lcs.simulate(scenario)
        frame = next(simulation)
        lcs_filter = lcs.Filter(scenario)
        result = lcs_filter.step(frame.corners, frame.motion)
        with tempfile.TemporaryDirectory() as folder:
            lcs.generate(CROSSING, frames=1, formats=["euroc"], out=folder + "/drive")
            live = lcs.Live(folder + "/drive/lcs.json")
        objects = [scenario, scenario.camera, simulation, frame, frame.motion, frame.truth, lcs_filter, live,
                   result, lcs.Detections(), lcs.Scorer(), lcs.Detector(scenario, "klt")]  # fmt: skip
        self.assertEqual({type(x) for x in objects}, set(self.CLASSES))
        for x in objects:
            before = repr(x)
            for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
                with self.assertRaises(TypeError, msg=(x, protocol)):
                    pickle.dumps(x, protocol)
            for make in (copy.copy, copy.deepcopy):
                with self.assertRaises(TypeError, msg=(x, make)):
                    make(x)
            self.assertEqual(repr(x), before)
        self.assertEqual(next(simulation).index, 1)


class Types(unittest.TestCase):
    """The stubs say what is there: no more, no less."""

    def test_stubs_name_what_the_module_has(self):
        named = set()
        stubs = ast.parse((Path(lcs.__file__).parent / "__init__.pyi").read_text(encoding="utf-8"))
        for node in stubs.body:
            named.add(getattr(node, "name", None) or getattr(getattr(node, "target", None), "id", None))
            if not isinstance(node, ast.ClassDef):
                continue
            real = getattr(lcs, node.name)
            members = {
                item.name: item for item in node.body if isinstance(item, ast.FunctionDef)
            }
            if issubclass(real, enum.IntEnum):
                numbers = {item.targets[0].id for item in node.body if isinstance(item, ast.Assign)}
                self.assertEqual(numbers, {member.name for member in real})
                continue
            public = {name for name in vars(real) if not name.startswith("_")}
            self.assertEqual({name for name in members if not name.startswith("_")}, public, node.name)
            for name in public:
                self.assertEqual(
                    isinstance(vars(real)[name], property), self.is_property(members[name]), name
                )
        self.assertLessEqual(set(lcs.__all__), named)
        self.assertTrue((Path(lcs.__file__).parent / "py.typed").exists())

    @staticmethod
    def is_property(function):
        return any(getattr(d, "id", "") == "property" for d in function.decorator_list)

    def test_everything_says_what_it_is(self):
        for name in lcs.__all__:
            self.assertTrue(hasattr(lcs, name), name)
            thing = getattr(lcs, name)
            if isinstance(thing, type):
                self.assertTrue(thing.__doc__, name)


if __name__ == "__main__":
    unittest.main()
