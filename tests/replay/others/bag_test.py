"""read_bag.py against bags that rosbags' own writers make: bag_test.py"""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError:
    print(f"SKIPPED: needs rosbags: {sys.executable} -m pip install rosbags==0.11.9")
    sys.exit(77)

SCRIPT = Path(__file__).resolve().parents[3] / "tools/replay/read_bag.py"
T0 = 1403715273_262142976  # ns; a float of seconds would round it
STORES = {"bag": Stores.ROS1_NOETIC, "db3": Stores.ROS2_HUMBLE, "mcap": Stores.ROS2_HUMBLE}
PIXELS = np.random.default_rng(1).integers(0, 256, (4, 6, 4), np.uint8)
PNG, JPEG = b"\x89PNG\r\n\x1a\nrest", b"\xff\xd8\xffrest"
IMU = [(0.1, -1 / 3, 1e-17, 9.81, np.pi, -5e300), (2**-40, 0.0, 1.0, -0.1, 0.2, 9.8)]
K = [400.5, 0, 3.25, 0, 401.5, 2.75, 0, 0, 1]
P = [390.0, 0, 3.0, 0, 0, 391.0, 2.0, 0, 0, 0, 1, 0]


class Maker:
    """A bag. Each call adds a message; `t` is its stamp, `at` its receive time."""

    def __init__(self, folder, kind):
        self.kind, self.store, self.connections = kind, get_typestore(STORES[kind]), {}
        self.path = folder / ("made.bag" if kind == "bag" else "made")
        if kind == "bag":  # ROS 1's own store lacks it
            transforms = "geometry_msgs/TransformStamped[] transforms"
            self.store.register(get_types_from_msg(transforms, "tf2_msgs/msg/TFMessage"))
            self.writer = rosbag1.Writer(self.path)
        else:
            plugins = {"mcap": rosbag2.StoragePlugin.MCAP, "db3": rosbag2.StoragePlugin.SQLITE3}
            self.writer = rosbag2.Writer(self.path, version=9, storage_plugin=plugins[kind])

    def make(self, type_, **given):
        """A message. One in it is given as a dict; numbers that are not given are zero."""
        fields = {}
        for name, (node, what) in self.store.fielddefs[type_][1]:
            if node.name == "NAME":
                fields[name] = self.make(what, **given.get(name, {}))
            else:
                fields[name] = given.get(name, np.zeros(what[1]) if node.name == "ARRAY" else 0)
        return self.store.types[type_](**fields)

    def add(self, topic, type_, t, frame, at=None, **fields):
        type_ = type_.replace("/", "/msg/")
        if frame:
            fields["header"] = header(t, frame)
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, type_, typestore=self.store)
        serialize = self.store.serialize_ros1 if self.kind == "bag" else self.store.serialize_cdr
        data = serialize(self.make(type_, **fields), type_)
        self.writer.write(self.connections[topic], at or t, data)

    def image(self, t, encoding="mono8", data=None, topic="/cam/image_raw", at=None, big=0, step=6):
        data = np.frombuffer(PIXELS[:, :, 0].tobytes() if data is None else data, np.uint8)
        self.add(topic, "sensor_msgs/Image", t, "cam_optical", at, width=6, height=4, step=step,
                 encoding=encoding, is_bigendian=big, data=data)  # fmt: skip

    def compressed(self, t, data, format_="jpeg"):
        self.add("/cam/image_raw/compressed", "sensor_msgs/CompressedImage", t, "cam_optical",
                 format=format_, data=np.frombuffer(data, np.uint8))  # fmt: skip

    def info(self, t, K=K, D=(0.1, 0.2, 0.3, 0.4), model="plumb_bob", topic="/cam/camera_info"):
        cased = str.upper if self.kind == "bag" else str.lower
        numbers = {cased(n): np.array(x, float) for n, x in (("D", D), ("K", K), ("P", P))}
        self.add(topic, "sensor_msgs/CameraInfo", t, "cam_optical", width=6, height=4,
                 distortion_model=model, **numbers)  # fmt: skip

    def imu(self, t, values=IMU[0], gyro=0.0, topic="/imu", frame="imu"):
        self.add(topic, "sensor_msgs/Imu", t, frame, angular_velocity=xyz(values[:3]),
                 linear_acceleration=xyz(values[3:]),
                 angular_velocity_covariance=np.array([gyro] + [0.0] * 8))  # fmt: skip

    def odometry(self, t, *T):
        twist = {"linear": xyz((1.5, 0.1, -0.2)), "angular": xyz((0, 0, 0.3))}
        self.add("/odom", "nav_msgs/Odometry", t, "odom", child_frame_id="base",
                 pose={"pose": pose(*T)}, twist={"twist": twist})  # fmt: skip

    def tf(self, topic, t, parent, child, *T):
        stamped = self.make("geometry_msgs/msg/TransformStamped", header=header(t, parent),
                            child_frame_id=child, transform=pose(*T))  # fmt: skip
        self.add(topic, "tf2_msgs/TFMessage", t, "", transforms=[stamped])


def header(t, frame):
    return {"stamp": {"sec": t // 10**9, "nanosec": t % 10**9}, "frame_id": frame}


def xyz(values, names="xyz"):
    return dict(zip(names, map(float, values)))


def pose(axis, angle, p):
    """Of a Pose or a Transform, by a turn about an axis."""
    vector = np.sin(angle / 2) * np.array(axis) / np.linalg.norm(axis)
    p, q = xyz(p), xyz((np.cos(angle / 2), *vector), "wxyz")
    return {"position": p, "translation": p, "orientation": q, "rotation": q}


def matrix(axis, angle, p):
    """The same by Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    T[:3, 3] = p
    return T


UP = (0, 0, 1)
BASE_IMU = ((1, 2, 3), 0.7, (0.1, -0.2, 0.3))
BASE_CAM = ((0, 1, 1), -2.1, (1.0, 0.5, 0.25))
ODOM_BASE = ((3, -1, 2), 1.1, (7.0, 8.0, -9.0))


def netpbm(file):
    magic, size, most, data = file.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    pixels = np.frombuffer(data, ">u2" if most == b"65535" else np.uint8)
    return pixels.reshape(height, width, -1 if magic == b"P6" else 1)


def lines_of(file):
    return file.read_text().splitlines()


class Bags(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = Path(kept.name)

    def run_script(self, *words, python=(sys.executable,)):
        words = [*python, SCRIPT, *words]
        return subprocess.run(words, capture_output=True, text=True, timeout=120)

    def bag(self, kind, *calls):
        maker = Maker(Path(tempfile.mkdtemp(dir=self.folder)), kind)
        with maker.writer:
            for call in calls:
                call(maker)
        return maker.path

    def converted(self, path, *words):
        out = Path(tempfile.mkdtemp(dir=self.folder)) / "out"
        done = self.run_script(path, "--out", out, *words)
        self.assertEqual((done.returncode, done.stderr, done.stdout), (0, "", ""))
        summary = json.loads((out / "bag.json").read_text())
        return out, summary, " ".join(summary["told"])

    def refused(self, says, path, *words):
        out = self.folder / "refused"
        done = self.run_script(path, "--out", out, *words)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertRegex(done.stderr, r"\Aerror: [^\n]+: [^\n]+; [^\n]+\n\Z")
        self.assertIn(says, done.stderr)
        self.assertFalse(out.exists())

    def whole(self, kind):
        def fill(m):
            m.tf("/tf_static", T0, "base", "imu", *BASE_IMU)
            m.tf("/tf_static", T0, "base", "cam_optical", *BASE_CAM)
            m.info(T0)
            for i in range(3):
                t = T0 + i * 50_000_001
                m.image(t, at=t + 7)
                m.imu(t, IMU[i % 2])
                m.odometry(t, *ODOM_BASE)

        return self.bag(kind, fill)

    def test_whole_recordings_of_each_format(self):
        for kind in STORES:
            path = self.whole(kind)
            self.check_whole(path)
            if kind != "bag":
                self.check_whole(path / f"{path.name}.{kind}")
                (path / "metadata.yaml").unlink()
                self.check_whole(path)

    def check_whole(self, path):
        out, summary, _ = self.converted(path, "--poses-topic", "/odom", "--imu-topic", "/imu",
                                         "--odometry-topic", "odom")  # fmt: skip
        self.assertNotIn("bayer", summary)
        times = [T0 + i * 50_000_001 for i in range(3)]
        camera, imu, odometry = (out / "mav0" / name for name in ("cam0", "imu0", "odometry0"))
        names = [f"{t},{t}.pgm" for t in times]
        self.assertEqual(lines_of(camera / "data.csv"), ["#timestamp [ns],filename", *names])
        for t in times:
            pixels = netpbm(camera / f"data/{t}.pgm")
            np.testing.assert_array_equal(pixels[:, :, 0], PIXELS[:, :, 0])
        self.assertEqual(len(list((camera / "data").iterdir())), 3)
        calibration = {"resolution: [6, 4]", "intrinsics: [400.5, 401.5, 3.25, 2.75]",
                       "distortion_model: radial-tangential", "rate_hz: 20.0",
                       "distortion_coefficients: [0.1, 0.2, 0.3, 0.4]"}  # fmt: skip
        self.assertLessEqual(calibration, set(lines_of(camera / "sensor.yaml")))
        rows = lines_of(imu / "data.csv")[1:]
        for row, t, values in zip(rows, times, [IMU[0], IMU[1], IMU[0]], strict=True):
            self.assertEqual(row, ",".join(map(repr, (t, *map(float, values)))))
        self.assertEqual(lines_of(odometry / "data.csv")[1], f"{T0},1.5,0.1,-0.2,0.3")
        T_SB = np.linalg.inv(matrix(*BASE_IMU))
        for folder, T in ((camera, T_SB @ matrix(*BASE_CAM)), (imu, np.eye(4)), (odometry, T_SB)):
            (data,) = re.findall(r" data: (.*)", (folder / "sensor.yaml").read_text())
            np.testing.assert_allclose(json.loads(data), T.ravel(), atol=1e-14)
        for line, t in zip(lines_of(out / "poses.txt"), times, strict=True):
            self.assertEqual(line.split()[0], f"{t // 10**9}.{t % 10**9:09}")
            self.check_pose(line, matrix(*ODOM_BASE) @ matrix(*BASE_CAM))

    def check_pose(self, line, T):
        *p, x, y, z, w = map(float, line.split()[1:])
        angle = 2 * np.arctan2(np.linalg.norm([x, y, z]), w)
        np.testing.assert_allclose(matrix((x, y, z), angle, p), T, atol=1e-12)

    def test_table_lists_topics_and_options(self):
        for kind in STORES:
            done = self.run_script(self.whole(kind))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            table, _, options = done.stdout.partition("\n\n")
            rows = {line.split()[0]: line.split()[1:] for line in table.splitlines()}
            self.assertEqual(rows["/imu"], ["sensor_msgs/Imu", "3", "0.100", "20.00"])
            self.assertLess({"topic", "/imu", "/odom", "/tf_static"}, set(rows))
            self.assertRegex(options, r"--poses-topic +/odom /tf_static\n")

    def test_pixels_of_each_encoding(self):
        grey, sixteen = PIXELS[:, :, 0], PIXELS[:, :, :2].copy().view("<u2")[:, :, 0]
        rgb, bgr = PIXELS[:, :, :3], PIXELS[:, :, 2::-1]
        layouts = {name: (grey, grey) for name in ("mono8", "8UC1", "bayer_grbg8")}
        layouts |= {"rgb8": (rgb, rgb), "rgba8": (PIXELS, rgb), "bgra8": (PIXELS, bgr)}
        layouts |= {"bgr8": (rgb, bgr), "8UC3": (rgb, bgr)}
        for name in ("mono16", "16UC1"):
            layouts[f"{name} 0"] = sixteen.astype("<u2").view(np.uint8), sixteen
            layouts[f"{name} 1"] = sixteen.astype(">u2").view(np.uint8), sixteen
        for name, (sent, expected) in layouts.items():
            rows = np.ascontiguousarray(sent).reshape(4, -1)
            padded = np.hstack([rows, np.full((4, 3), 99, np.uint8)])
            encoding, _, big = name.partition(" ")
            sent = {"data": padded.tobytes(), "big": int(big or 0), "step": padded.shape[1]}
            path = self.bag("mcap", lambda m: m.image(T0, encoding, **sent))
            out, summary, _ = self.converted(path)
            (file,) = (out / "mav0/cam0/data").iterdir()
            np.testing.assert_array_equal(netpbm(file).squeeze(), expected, name)
            self.assertEqual(file.suffix, ".ppm" if expected.ndim == 3 else ".pgm")
            self.assertEqual(summary.get("bayer"), "grbg" if "bayer" in name else None)

    def test_compressed_pictures_of_unlinked_frames(self):
        fill = lambda m: (m.compressed(T0, JPEG), m.compressed(T0 + 1, PNG), m.info(T0), m.imu(T0))
        out, _, told = self.converted(self.bag("bag", fill))
        self.assertEqual((out / f"mav0/cam0/data/{T0}.jpg").read_bytes(), JPEG)
        self.assertEqual((out / f"mav0/cam0/data/{T0 + 1}.png").read_bytes(), PNG)
        self.assertIn("links the frames 'imu' (IMU) and 'cam_optical' (camera)", told)
        self.assertNotIn("T_BS", (out / "mav0/cam0/sensor.yaml").read_text())

    def test_receive_times_where_stamps_are_no_use(self):
        for stamps in ((0, 0), (T0, T0)):
            sent = [(T0 + 9 + i, t) for i, t in enumerate(stamps)]
            path = self.bag("db3", lambda m: [(m.image(t, at=at), m.imu(at)) for at, t in sent])
            out, _, told = self.converted(path)
            self.assertIn("all 0, mostly repeat or fall back", told)
            rows = lines_of(out / "mav0/cam0/data.csv")[1:]
            self.assertEqual(rows, [f"{at},{at}.pgm" for at, _ in sent])

    def test_one_stamp_that_repeats_leaves_the_others(self):
        stamps = [T0 + i * 50_000_000 for i in (*range(20), 12)]
        path = self.bag("bag", *(lambda m, t=t: m.image(t, at=t + 9) for t in stamps))
        out, _, told = self.converted(path)
        self.assertIn("1 pictures have the time of another one and are left out", told)
        rows = lines_of(out / "mav0/cam0/data.csv")[1:]
        self.assertEqual(rows, [f"{t},{t}.pgm" for t in stamps[:-1]])

    def test_a_clock_that_falls_back_is_not_taken(self):
        stamps = [T0 + i * 50_000_000 for i in (*range(20), *range(5, 25))]
        sent = [(T0 + i * 50_000_000, t) for i, t in enumerate(stamps)]
        path = self.bag("bag", *(lambda m, s=s: m.image(s[1], at=s[0]) for s in sent))
        self.assertIn("fall back", self.converted(path)[2])

    def two_topics(self, *more, frame="imu", offset=0):
        def fill(m):
            for i in range(9):
                m.image(T0 + i * 10_000_000)
                m.imu(T0 + i * 10_000_000, (0.1 * i, 0, 0, 0, 0, 0), topic="/gyro")
                if i % 4 == 0:
                    m.imu(T0 + offset + i * 10_000_000, (0, 0, 0, i, 2 * i, 9.8), topic="/accel",
                          frame=frame, gyro=-1.0)  # fmt: skip
            for call in more:
                call(m)

        return self.bag("bag", fill)

    def rows_of(self, path, topic, **given):
        out, _, told = self.converted(path, "--imu-topic", topic)
        self.assertIn("the accelerations of /accel are interpolated to the times of /gyro", told)
        lines = lines_of(out / "mav0/imu0/data.csv")[1:]
        return [[float(x) for x in line.split(",")[1:]] for line in lines]

    def test_an_imu_in_two_topics_is_joined_at_the_times_of_the_gyroscope(self):
        expected = [[0.1 * i, 0, 0, i, 2 * i, 9.8] for i in range(9)]
        for topic in ("/gyro", "/accel"):
            np.testing.assert_allclose(self.rows_of(self.two_topics(), topic), expected, atol=1e-12)
        later = self.rows_of(self.two_topics(offset=5_000_000), "/gyro")
        np.testing.assert_allclose(later, [[0.1 * i, 0, 0, i - 0.5, 2 * i - 1, 9.8] for i in range(1, 9)],
                                   atol=1e-6)  # fmt: skip
        told = self.converted(self.two_topics(), "--own-motion")[2]
        self.assertIn("the bag's IMU /accel /gyro is not read", told)

    def test_an_imu_in_two_topics_is_turned_by_the_transform_of_their_frames(self):
        turn = lambda m: m.tf("/tf_static", T0, "imu", "accel", UP, np.pi / 2, (0, 0, 0))
        rows = self.rows_of(self.two_topics(turn, frame="accel"), "/gyro")
        np.testing.assert_allclose(rows, [[0.1 * i, 0, 0, -2 * i, i, 9.8] for i in range(9)], atol=1e-12)

    def test_an_imu_in_topics_that_cannot_be_joined_is_refused_with_the_neutral_way(self):
        third = lambda m: m.imu(T0, (0, 0, 0, 0, 0, 9.8), topic="/accel2")
        for path, why in ((self.two_topics(third), "/gyro has no linear acceleration, and not just one other topic "
                                                   "has it alone (/accel /accel2)"),
                          (self.two_topics(frame="other"), "links the frames 'imu' of /gyro and 'other' of /accel"),
                          (self.two_topics(offset=10**12), "have no common time")):  # fmt: skip
            self.refused(why, path, "--imu-topic", "/gyro")
            self.refused("NEUTRAL.md", path, "--imu-topic", "/gyro")

    def test_an_mcap_whose_summary_repeats_no_channel_is_read(self):
        try:
            from mcap.reader import make_reader
            from mcap.writer import Writer
        except ImportError:
            self.skipTest("needs mcap")
        made = next(self.bag("mcap", *(lambda m, i=i: m.image(T0 + i) for i in range(3))).glob("*.mcap"))
        bare = self.folder / "bare.mcap"
        with made.open("rb") as old, bare.open("wb") as new:
            writer = Writer(new, repeat_channels=False, repeat_schemas=False, use_statistics=False)
            writer.start(profile="ros2", library="")
            channels = {}
            for schema, channel, message in make_reader(old).iter_messages():
                if channel.topic not in channels:
                    kind = writer.register_schema(schema.name, schema.encoding, schema.data)
                    channels[channel.topic] = writer.register_channel(channel.topic, "cdr", kind)
                writer.add_message(channels[channel.topic], message.log_time, message.data, message.log_time)
            writer.finish()
        out, _, _ = self.converted(bare)
        self.assertEqual(lines_of(out / "mav0/cam0/data.csv")[1:], [f"{T0 + i},{T0 + i}.pgm" for i in range(3)])

    def test_an_mcap_of_another_profile_is_refused_by_its_name(self):
        for profile in (b"ros1", b""):
            file = self.folder / "other.mcap"
            file.write_bytes(b"\x89MCAP0\r\n\x01" + bytes(8) + len(profile).to_bytes(4, "little")
                             + profile + bytes(64))  # fmt: skip
            self.refused(f"a sound MCAP of the profile {profile.decode()!r}", file)

    def test_calibrations(self):
        for model, says, topic, info in (
            ("equidistant", "model: equidistant\n", "/cam/image_raw", {}),
            ("equidistant", "coefficients: [0.0, 0.0, 0.0, 0.0]", "/cam/image_raw", {"D": [0] * 4}),
            ("rational_polynomial", "radial-tangential", "/cam/image_raw", {"D": [0.1] * 8}),
            ("", "distortion_model: none\n", "/cam/image_raw", {"D": ()}),
            ("odd", "intrinsics: [390.0, 391.0, 3.0, 2.0]\n", "/cam/image_rect_color", {}),
            ("plumb_bob", "focal lengths are [0.0, 0.0] pixels", "/cam/image_raw", {"K": [0] * 9}),
            ("odd", "its distortion is 'odd'", "/cam/image_raw", {}),
        ):
            fill = lambda m: (m.image(T0, topic=topic), m.info(T0, model=model, **info))
            out, _, told = self.converted(self.bag("mcap", fill))
            text = (out / "mav0/cam0/sensor.yaml").read_text()
            self.assertIn(says, text + told)
            self.assertEqual("intrinsics" in text, "not calibrated" not in told)

    def test_poses_of_tf_and_of_messages_without_a_child(self):
        def fill(m):
            m.tf("/tf_static", T0, "base", "cam_optical", *BASE_CAM)
            for i in range(5):
                t = T0 + i * 10**8
                m.image(t)
                m.tf("/tf", t, "odom", "base", UP, 0.2 * i, (i, 0, 0))
                if i % 4 == 0:
                    m.tf("/tf", t, "map", "odom", UP, 0.1 * i, (0, i, 0))
                m.add("/pose", "geometry_msgs/PoseStamped", t, "map", pose=pose(*ODOM_BASE))

        path = self.bag("bag", fill)
        out, _, _ = self.converted(path, "--poses-topic", "/tf", "--world-frame", "map")
        for i, line in zip(range(5), lines_of(out / "poses.txt"), strict=True):
            T_MO, T_OB = matrix(UP, 0.1 * i, (0, i, 0)), matrix(UP, 0.2 * i, (i, 0, 0))
            self.check_pose(line, T_MO @ T_OB @ matrix(*BASE_CAM))
        out, _, told = self.converted(path)
        self.assertIn("taken as the camera's", told)
        self.check_pose(lines_of(out / "poses.txt")[4], matrix(*ODOM_BASE))
        self.refused("--world-frame, perhaps map", path, "--poses-topic", "/tf")
        self.refused("'earth' and 'cam_optical'", path, "--poses-topic=/tf", "--world-frame=earth")

    def test_refusals(self):
        image = lambda m: m.image(T0)
        two = lambda m: (m.image(T0), m.image(T0, topic="/right/image_raw"))
        imus = lambda m: (m.image(T0), m.imu(T0), m.imu(T0, topic="/imu2"))
        odometry = lambda m: m.odometry(T0, *ODOM_BASE)
        for says, calls, words in (
            ("no topic of sensor_msgs/Image", [odometry], ()),
            ("--image-topic, one of /cam/image_raw /right/image_raw", [two], ()),
            ("--imu-topic, one of /imu /imu2", [imus], ()),
            ("has no messages /other", [image], ("--image-topic", "/other")),
            ("format 'yuv422'", [lambda m: m.image(T0, "yuv422")], ()),
            ("format 'tiff'", [lambda m: m.compressed(T0, b"II*\0", format_="tiff")], ()),
            ("/imu has no angular velocity", [image, lambda m: m.imu(T0, gyro=-1.0)], ()),
            ("the frames 'base' and 'cam_optical'", [image, odometry], ("--poses-topic", "/odom")),
            ("no message of /cam/image_raw can be read", [lambda m: m.image(T0, step=5)], ()),
            ("File exists", [image], ("--out", self.folder)),
        ):  # fmt: skip
            with self.subTest(says):
                self.refused(says, self.bag("bag", *calls), *words)
        self.refused("does not exist", self.folder / "none.bag")
        self.refused("give a whole .bag, .db3, .mcap", SCRIPT)

    def test_damage(self):
        for kind in STORES:
            path = self.whole(kind)
            file = path if kind == "bag" else path / f"{path.name}.{kind}"
            file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
            self.refused(path.name, file)
        short = lambda m: m.image(T0 + 1, data=b"short")
        _, _, told = self.converted(self.bag("mcap", lambda m: m.image(T0), short))
        self.assertIn("1 messages of /cam/image_raw are unreadable and left out, first at", told)

    def test_unbounded_decompression_is_refused(self):
        for kind, compression in (
            ("bag", (rosbag1.Writer.CompressionFormat.BZ2,)),
            ("bag", (rosbag1.Writer.CompressionFormat.LZ4,)),
            ("mcap", (rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)),
            ("db3", (rosbag2.CompressionMode.MESSAGE, rosbag2.CompressionFormat.ZSTD)),
        ):
            with self.subTest(kind=kind, compression=compression):
                maker = Maker(Path(tempfile.mkdtemp(dir=self.folder)), kind)
                maker.writer.set_compression(*compression)
                with maker.writer:
                    maker.compressed(T0, bytes(300 << 20))
                files = [maker.path, *maker.path.glob("*")]
                self.assertLess(sum(file.stat().st_size for file in files), 8 << 20)
                self.refused("more than 256 MiB once it is decompressed; write", maker.path)

    def test_without_rosbags(self):
        done = self.run_script("some.bag", python=(sys.executable, "-I", "-S"))
        says = "error: some.bag: reading bags needs the Python package rosbags; install it with: "
        says += f"{sys.executable} -m pip install rosbags\n"
        self.assertEqual((done.returncode, done.stderr), (3, says))


if __name__ == "__main__":
    unittest.main()
