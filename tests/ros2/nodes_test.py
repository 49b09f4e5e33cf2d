"""The nodes of ROS 2 over loopback: nodes_test.py PROGRAM NODES

1,000 pictures at 30 Hz: none is lost, and each answer has the bytes of lcs replay of the same
sequence. Wrong messages end detect with their topic and a remedy. rclpy is installed by

    /usr/bin/python3 -m venv ros && ros/bin/pip install -r tools/ros2/requirements.txt

and this test then runs with LCS_PYTHON=ros/bin/python.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
os.environ["ROS_DOMAIN_ID"] = str(1 + os.getpid() % 100)  # apart from other programs of this machine
PROGRAM, NODES = sys.argv[1:3]
PICTURES, RATE_HZ = 1000, 30

try:
    import lcs
    import numpy as np
    import rclpy
    from builtin_interfaces.msg import Time
    from geometry_msgs.msg import PoseStamped, Vector3
    from rclpy.qos import QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
    from sensor_msgs.msg import CameraInfo, Image, Imu, PointCloud2
    from std_msgs.msg import Header
except ImportError as missing:
    print(f"SKIPPED: {missing} in {sys.executable}; {__file__} says how to install rclpy")
    sys.exit(77)

NONE_LOST = QoSProfile(reliability=QoSReliabilityPolicy.RELIABLE, history=QoSHistoryPolicy.KEEP_ALL)
TYPES = {2: "u1", 5: "i4", 7: "f4", 8: "f8"}  # of sensor_msgs/PointField


def stamp_ns(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def columns_of(message):
    """The columns of a table by their names."""
    names = [field.name for field in message.fields]
    formats = ["<" + TYPES[field.datatype] for field in message.fields]
    offsets = [field.offset for field in message.fields]
    layout = {"names": names, "formats": formats, "offsets": offsets, "itemsize": message.point_step}
    rows = np.frombuffer(bytes(message.data), np.dtype(layout))
    assert len(rows) == message.width
    return {name: rows[name] for name in names}


def started(*words):
    return subprocess.Popen([sys.executable, NODES, *map(str, words)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


class Nodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        rclpy.init()
        cls.addClassCleanup(rclpy.try_shutdown)

    def setUp(self):
        self.node = rclpy.create_node("test")
        self.addCleanup(self.node.destroy_node)

    def program(self, *words):
        subprocess.run([PROGRAM, *map(str, words), "--quiet"], check=True, cwd=self.folder)

    def sequence(self, name, pictures):
        sets = [f"camera.rate={RATE_HZ} Hz", f"frames={pictures}", "camera.size=[320, 240]", "ego.speed=0.2 m/s"]
        words = [word for each in sets for word in ("--set", each)]
        self.program("generate", "crossing", *words, "--formats", "euroc", "--out", name)
        return self.folder / name

    def spin_until(self, is_done, timeout_s, *processes):
        end = time.monotonic() + timeout_s
        while not is_done() and time.monotonic() < end:
            rclpy.spin_once(self.node, timeout_sec=0.05)
            if any(process.poll() not in (None, 0) for process in processes):
                break

    def test_a_thousand_pictures_have_the_answers_of_a_replay(self):
        sequence = self.sequence("drive", PICTURES)
        self.program("replay", sequence, "--no-video", "--out", "replay")
        got = {"corners": [], "boxes": [], "info": [], "truth": []}
        for kind, topic, name in ((PointCloud2, "/lcs/corners", "corners"), (PointCloud2, "/lcs/boxes", "boxes"),
                                  (CameraInfo, "/cam0/camera_info", "info"), (PoseStamped, "/truth/pose", "truth")):
            self.node.create_subscription(kind, topic, got[name].append, NONE_LOST)
        detect = started("detect", sequence)
        self.addCleanup(detect.kill)
        self.spin_until(lambda: self.node.count_publishers("/lcs/boxes") > 0, 60, detect)
        began = time.monotonic()
        publish = started("publish", sequence)
        self.addCleanup(publish.kill)
        truths = (sequence / "mav0/state_groundtruth_estimate0/data.csv").read_text().count("\n") - 1
        self.spin_until(lambda: len(got["boxes"]) >= PICTURES and len(got["corners"]) >= PICTURES
                        and len(got["truth"]) >= truths, 600, detect, publish)
        took_s = time.monotonic() - began
        said, wrong = publish.communicate(timeout=60)
        self.assertEqual(publish.returncode, 0, wrong)
        self.assertIn(f"sent {PICTURES} pictures", said)
        self.assertGreaterEqual(took_s, (PICTURES - 1) / RATE_HZ, "the pictures came before their time")
        detect.send_signal(signal.SIGINT)
        said, wrong = detect.communicate(timeout=60)
        self.assertEqual((detect.returncode, wrong), (130, ""))
        self.assertIn(f"{PICTURES} pictures", said)

        names = [line.split(",")[0] for line in (sequence / "mav0/cam0/data.csv").read_text().split("\n")[1:-1]]
        for name in ("corners", "boxes", "info"):
            self.assertEqual([str(stamp_ns(message)) for message in got[name]], names, name)
        self.assertEqual(len(got["truth"]), truths)
        self.assertEqual((got["info"][0].width, got["info"][0].height), (320, 240))

        rebels = 0
        with (self.folder / "replay/layers.jsonl").open() as lines:
            frames = [json.loads(line) for line in lines]
        self.assertEqual(len(frames), PICTURES)
        for frame, corners, boxes in zip(frames, map(columns_of, got["corners"]), map(columns_of, got["boxes"])):
            said = frame["corners"]
            expected = {
                "x": np.array(said["x"], "f4"), "y": np.array(said["y"], "f4"),
                "verdict": np.array([lcs.Verdict[word.upper()] for word in said["verdict"]], "u1"),
                "reason": np.array([lcs.Reason[word.upper()] for word in said["reason"]], "u1"),
            }
            for name, column in expected.items():
                self.assertEqual(corners[name].tobytes(), column.tobytes(), (frame["index"], name))
            np.testing.assert_allclose(corners["log_odds"], frame.get("log_odds", []), atol=0.0051, rtol=1e-6)
            rebels += int((corners["verdict"] == lcs.Verdict.REBEL).sum())
            squares = {name: np.array(frame["squares"][name], "f8") for name in
                       ("x", "y", "half_width", "half_height", "id", "rebel_circles")}
            edges = {
                "left": squares["x"] - squares["half_width"] + 0.5, "right": squares["x"] + squares["half_width"] + 0.5,
                "top": squares["y"] - squares["half_height"] + 0.5, "bottom": squares["y"] + squares["half_height"] + 0.5,
                "id": squares["id"].astype("i4"), "moves": (squares["rebel_circles"] > 0).astype("u1"),
            }
            for name, column in edges.items():
                self.assertEqual(boxes[name].tobytes(), column.tobytes(), (frame["index"], name))
        self.assertGreater(rebels, PICTURES, "hardly anything moves, so that equal verdicts say little")

    def refused(self, send):
        """What detect prints when it ends by wrong messages. send: is called until then."""
        settings = self.sequence("short", 2) if not (self.folder / "short").exists() else self.folder / "short"
        detect = started("detect", settings)
        self.addCleanup(detect.kill)
        self.imu = self.node.create_publisher(Imu, "/imu0", NONE_LOST)
        self.pictures = self.node.create_publisher(Image, "/cam0/image_raw", NONE_LOST)
        self.spin_until(lambda: min(to.get_subscription_count() for to in (self.imu, self.pictures)) > 0, 60, detect)
        send()
        _, wrong = detect.communicate(timeout=60)
        self.assertEqual(detect.returncode, 2, wrong)
        self.assertEqual(wrong.count("\n"), 1, wrong)
        return wrong

    def header(self, t_ns):
        return Header(stamp=Time(sec=t_ns // 10**9, nanosec=t_ns % 10**9))

    def send_imu(self, *times_ns):
        for t_ns in times_ns:
            self.imu.publish(Imu(header=self.header(t_ns), linear_acceleration=Vector3(z=9.81)))

    def send_picture(self, t_ns, width=320, encoding="mono8"):
        self.pictures.publish(Image(header=self.header(t_ns), height=240, width=width, step=width,
                                    encoding=encoding, data=bytes(240 * width)))

    def test_pictures_without_an_imu_are_refused(self):
        wrong = self.refused(lambda: [self.send_picture(t * 10**8) for t in range(1, 40)])
        self.assertRegex(wrong, "^error: /imu0: no reading before the first picture of /cam0/image_raw; start it first")

    def test_an_imu_that_begins_later_is_refused(self):
        wrong = self.refused(lambda: [self.send_picture(10**9), self.send_imu(2 * 10**9)])
        self.assertRegex(wrong, "^error: /imu0: no reading before the first picture of /cam0/image_raw; start it first")

    def test_stamps_that_go_back_are_refused(self):
        wrong = self.refused(lambda: self.send_imu(10**9, 2 * 10**9, 10**9))
        self.assertRegex(wrong, "^error: /imu0: the time goes back from 2000000000 to 1000000000 ns; begin anew")

    def test_a_picture_of_another_size_is_refused(self):
        wrong = self.refused(lambda: [self.send_imu(10**9, 2 * 10**9), self.send_picture(10**9, 160)])
        self.assertRegex(wrong, "^error: /cam0/image_raw: the picture has 160 x 240 pixels, and the settings say 320 x")

    def test_an_unknown_encoding_is_refused(self):
        wrong = self.refused(lambda: [self.send_imu(10**9, 2 * 10**9), self.send_picture(10**9, 320, "yuv422")])
        self.assertRegex(wrong, "^error: /cam0/image_raw: the encoding is yuv422; give one of bgr8, rgb8, mono8")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
