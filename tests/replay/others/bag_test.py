"""read_bag.py against bags that rosbags' own writers make: bag_test.py [READ_BAG]"""

import json
import os
import signal
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
    print(f"SKIPPED: there is no rosbags to test with: {sys.executable} -m pip install rosbags==0.11.9")
    sys.exit(77)

ROOT = Path(__file__).resolve().parents[3]
SCRIPT = ROOT / "tools" / "replay" / "read_bag.py"
T0 = 1403715273_262142976  # ns; a float of seconds would round it
STORES = {"bag": Stores.ROS1_NOETIC, "db3": Stores.ROS2_HUMBLE, "mcap": Stores.ROS2_HUMBLE}
PIXELS = np.random.default_rng(1).integers(0, 256, (4, 6, 4), np.uint8)
PNG = b"\x89PNG\r\n\x1a\n" + b"\0\0\0\rIHDR" + bytes([0, 0, 0, 6, 0, 0, 0, 4]) + b"rest"
JPEG = b"\xff\xd8\xff\xe0\0\x04ab\xff\xc0\0\x0b\x08\0\x04\0\x06rest"
IMU = [(0.1, -1 / 3, 1e-17, 9.81, np.pi, -5e300), (2**-40, 0.0, 1.0, -0.1, 0.2, 9.8)]
K = [400.5, 0, 3.25, 0, 401.5, 2.75, 0, 0, 1]
P = [390.0, 0, 3.0, 0, 0, 391.0, 2.0, 0, 0, 0, 1, 0]


class Maker:
    """A bag in one of the three formats. Calls add a message; `t` is its stamp, `at` its receive time."""

    def __init__(self, folder, kind, name="made"):
        self.kind, self.store, self.connections = kind, get_typestore(STORES[kind]), {}
        self.path = Path(folder) / (f"{name}.bag" if kind == "bag" else name)
        if kind == "bag":  # ROS 1's own store lacks it
            tf = get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage")
            self.store.register(tf)
        plugin = rosbag2.StoragePlugin.MCAP if kind == "mcap" else rosbag2.StoragePlugin.SQLITE3
        self.writer = (
            rosbag1.Writer(self.path)
            if kind == "bag"
            else rosbag2.Writer(self.path, version=9, storage_plugin=plugin)
        )

    def __enter__(self):
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def make(self, type_, **fields):
        package, name = type_.split("/")
        return self.store.types[f"{package}/msg/{name}"](**fields)

    def header(self, t, frame):
        stamp = self.make("builtin_interfaces/Time", sec=t // 10**9, nanosec=t % 10**9)
        sequence = {"seq": 0} if self.kind == "bag" else {}
        return self.make("std_msgs/Header", stamp=stamp, frame_id=frame, **sequence)

    def raw(self, topic, type_, at, data):
        if topic not in self.connections:
            full = type_.replace("/", "/msg/")
            self.connections[topic] = self.writer.add_connection(topic, full, typestore=self.store)
        self.writer.write(self.connections[topic], at, data)

    def add(self, topic, type_, at, **fields):
        serialize = self.store.serialize_ros1 if self.kind == "bag" else self.store.serialize_cdr
        full = type_.replace("/", "/msg/")
        self.raw(topic, type_, at, serialize(self.make(type_, **fields), full))

    def xyz(self, values, type_="geometry_msgs/Vector3"):
        return self.make(type_, **dict(zip("xyz", map(float, values))))

    def quaternion(self, q):
        return self.make("geometry_msgs/Quaternion", **dict(zip("wxyz", map(float, q))))

    def pose(self, q, p):
        point = self.xyz(p, "geometry_msgs/Point")
        return self.make("geometry_msgs/Pose", position=point, orientation=self.quaternion(q))

    def image(self, t, encoding="mono8", data=None, topic="/cam/image_raw", at=None, size=(6, 4),
              big=0, step=None, frame="cam_optical"):  # fmt: skip
        data = PIXELS[:, :, 0].tobytes() if data is None else data
        self.add(topic, "sensor_msgs/Image", t if at is None else at, header=self.header(t, frame),
                 width=size[0], height=size[1], encoding=encoding, is_bigendian=big,
                 step=size[0] if step is None else step, data=np.frombuffer(data, np.uint8))  # fmt: skip

    def compressed(self, t, data, topic="/cam/image_raw/compressed", format_="jpeg"):
        self.add(topic, "sensor_msgs/CompressedImage", t, header=self.header(t, "cam_optical"),
                 format=format_, data=np.frombuffer(data, np.uint8))  # fmt: skip

    def info(self, t, K=K, D=(0.1, 0.2, 0.3, 0.4), model="plumb_bob", size=(6, 4), topic="/cam/camera_info"):
        fields = {"D": D, "K": K, "R": np.eye(3).ravel(), "P": P}
        cased = str.upper if self.kind == "bag" else str.lower
        arrays = {cased(name): np.array(value, float) for name, value in fields.items()}
        roi = self.make("sensor_msgs/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0,
                        do_rectify=False)  # fmt: skip
        self.add(topic, "sensor_msgs/CameraInfo", t, header=self.header(t, "cam_optical"),
                 width=size[0], height=size[1], distortion_model=model, binning_x=0, binning_y=0,
                 roi=roi, **arrays)  # fmt: skip

    def imu(self, t, values=IMU[0], gyro=0.0, topic="/imu", frame="imu"):
        rates = np.array([gyro] + [0.0] * 8)
        self.add(topic, "sensor_msgs/Imu", t, header=self.header(t, frame),
                 orientation=self.quaternion((1, 0, 0, 0)), orientation_covariance=np.zeros(9),
                 angular_velocity=self.xyz(values[:3]), angular_velocity_covariance=rates,
                 linear_acceleration=self.xyz(values[3:]), linear_acceleration_covariance=np.zeros(9))  # fmt: skip

    def pose_stamped(self, t, q, p, topic="/pose", frame="map"):
        self.add(topic, "geometry_msgs/PoseStamped", t, header=self.header(t, frame), pose=self.pose(q, p))

    def odometry(self, t, q, p, v=(1.5, 0.1, -0.2), yaw=0.3, child="base"):
        twist = self.make("geometry_msgs/Twist", linear=self.xyz(v), angular=self.xyz((0, 0, yaw)))
        self.add("/odom", "nav_msgs/Odometry", t, header=self.header(t, "odom"), child_frame_id=child,
                 pose=self.make("geometry_msgs/PoseWithCovariance", pose=self.pose(q, p),
                                covariance=np.zeros(36)),
                 twist=self.make("geometry_msgs/TwistWithCovariance", twist=twist,
                                 covariance=np.zeros(36)))  # fmt: skip

    def tf(self, t, parent, child, q, p, topic="/tf_static"):
        transform = self.make("geometry_msgs/Transform", translation=self.xyz(p), rotation=self.quaternion(q))
        stamped = self.make("geometry_msgs/TransformStamped", header=self.header(t, parent),
                            child_frame_id=child, transform=transform)  # fmt: skip
        self.add(topic, "tf2_msgs/TFMessage", t, transforms=[stamped])


def turn(axis, angle):
    """The quaternion w x y z of a turn about an axis."""
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.array(axis) / np.linalg.norm(axis))])


def matrix(axis, angle, p):
    """The same turn by Rodrigues' formula, with a translation."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    T[:3, 3] = p
    return T


BASE_IMU = ((1, 2, 3), 0.7, (0.1, -0.2, 0.3))
BASE_CAM = ((0, 1, 1), -2.1, (1.0, 0.5, 0.25))
ODOM_BASE = ((3, -1, 2), 1.1, (7.0, 8.0, -9.0))
T_SC = np.linalg.inv(matrix(*BASE_IMU)) @ matrix(*BASE_CAM)


def link(maker):
    for child, (axis, angle, p) in (("imu", BASE_IMU), ("cam_optical", BASE_CAM)):
        maker.tf(T0, "base", child, turn(axis, angle), p)


def netpbm(file):
    magic, size, most, data = file.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    pixels = np.frombuffer(data, ">u2" if most == b"65535" else np.uint8)
    return pixels.reshape(height, width, -1 if magic == b"P6" else 1)


def numbers_of(yaml, key):
    line = next(line for line in yaml.splitlines() if line.strip().startswith(key + ":"))
    return json.loads(line.split(":", 1)[1])


class Bags(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = Path(kept.name)
        self.count = 0

    def run_script(self, *words, python=(sys.executable,)):
        return subprocess.run([*python, SCRIPT, *words], capture_output=True, text=True, timeout=120)

    def bag(self, kind, *calls):
        self.count += 1
        with Maker(self.folder, kind, f"made{self.count}") as maker:
            for call in calls:
                call(maker)
        return maker.path

    def converted(self, path, *words):
        self.count += 1
        out = self.folder / f"out{self.count}"
        done = self.run_script(path, "--out", out, *words)
        self.assertEqual((done.returncode, done.stderr, done.stdout), (0, "", ""))
        return out, json.loads((out / "bag.json").read_text())

    def refused(self, says, path, *words, code=2):
        out = self.folder / "refused"
        done = self.run_script(path, "--out", out, *words)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertRegex(done.stderr, r"\Aerror: [^\n]+: [^\n]+; [^\n]+\n\Z")
        self.assertIn(says, done.stderr)
        self.assertFalse(out.exists())
        return done

    def whole(self, kind):
        def fill(m):
            link(m)
            m.info(T0)
            for i in range(3):
                t = T0 + i * 50_000_001
                m.image(t, at=t + 7)
                m.imu(t, IMU[i % 2])
                axis, angle, p = ODOM_BASE
                m.odometry(t, turn(axis, angle), p)

        return self.bag(kind, fill)

    def test_whole_recordings_of_each_format(self):
        for kind in STORES:
            path = self.whole(kind)
            paths = [path]
            if kind != "bag":
                paths.append(path / f"{path.name}.{kind}")
            for given in paths:
                with self.subTest(given.name):
                    self.check_whole(given)
            if kind != "bag":
                (path / "metadata.yaml").unlink()
                self.check_whole(path)

    def check_whole(self, path):
        out, summary = self.converted(path, "--poses-topic", "/odom", "--imu-topic", "/imu",
                                      "--odometry-topic", "odom")  # fmt: skip
        self.assertNotIn("bayer", summary)
        times = [T0 + i * 50_000_001 for i in range(3)]
        rows = (out / "mav0/cam0/data.csv").read_text().splitlines()
        self.assertEqual(rows, ["#timestamp [ns],filename"] + [f"{t},{t}.pgm" for t in times])
        for t in times:
            np.testing.assert_array_equal(netpbm(out / f"mav0/cam0/data/{t}.pgm")[:, :, 0], PIXELS[:, :, 0])
        self.assertEqual(len(list((out / "mav0/cam0/data").iterdir())), 3)
        yaml = (out / "mav0/cam0/sensor.yaml").read_text()
        np.testing.assert_allclose(numbers_of(yaml, "data"), T_SC.ravel(), atol=1e-14)
        self.assertEqual(numbers_of(yaml, "intrinsics"), [400.5, 401.5, 3.25, 2.75])
        self.assertEqual(numbers_of(yaml, "distortion_coefficients"), [0.1, 0.2, 0.3, 0.4])
        self.assertEqual(numbers_of(yaml, "resolution"), [6, 4])
        self.assertEqual(numbers_of(yaml, "rate_hz"), 20)
        self.assertIn("distortion_model: radial-tangential\n", yaml)
        rows = (out / "mav0/imu0/data.csv").read_text().splitlines()[1:]
        for row, t, values in zip(rows, times, [IMU[0], IMU[1], IMU[0]], strict=True):
            self.assertEqual([float(x) for x in row.split(",")[1:]], list(values))
            self.assertEqual(int(row.split(",")[0]), t)
        yaml = (out / "mav0/imu0/sensor.yaml").read_text()
        self.assertEqual(numbers_of(yaml, "data"), np.eye(4).ravel().tolist())
        rows = (out / "mav0/odometry0/data.csv").read_text().splitlines()
        self.assertEqual(rows[1], f"{T0},1.5,0.1,-0.2,0.3")
        yaml = (out / "mav0/odometry0/sensor.yaml").read_text()
        np.testing.assert_allclose(numbers_of(yaml, "data"), np.linalg.inv(matrix(*BASE_IMU)).ravel(), atol=1e-14)
        T_WC = matrix(*ODOM_BASE) @ matrix(*BASE_CAM)
        lines = (out / "poses.txt").read_text().splitlines()
        self.assertEqual([line.split()[0] for line in lines], [f"{t // 10**9}.{t % 10**9:09}" for t in times])
        for line in lines:
            self.check_pose(line, T_WC)

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
            topics = {"/imu", "/odom", "/tf_static", "/cam/image_raw", "/cam/camera_info"}
            self.assertEqual(set(rows), {"topic", *topics})
            self.assertEqual(len({len(line.rstrip()) for line in table.splitlines()}), 1, "aligned")
            self.assertRegex(options, r"--image-topic +/cam/image_raw\n")
            self.assertRegex(options, r"--poses-topic +/odom /tf_static\n")

    def test_pixels_of_each_encoding(self):
        grey, sixteen = PIXELS[:, :, 0], PIXELS[:, :, :2].copy().view("<u2")[:, :, 0]
        layouts = {"mono8": (grey, grey), "8UC1": (grey, grey), "bayer_grbg8": (grey, grey),
                   "rgb8": (PIXELS[:, :, :3], PIXELS[:, :, :3]), "rgba8": (PIXELS, PIXELS[:, :, :3])}  # fmt: skip
        for name, width in (("bgr8", 3), ("8UC3", 3), ("bgra8", 4)):
            layouts[name] = (PIXELS[:, :, :width], PIXELS[:, :, 2::-1])
        for big, order in ((0, "<u2"), (1, ">u2")):
            for name in ("mono16", "16UC1"):
                layouts[f"{name} {big}"] = (sixteen.astype(order).view(np.uint8), sixteen)
        for name, (sent, expected) in layouts.items():
            rows = np.ascontiguousarray(sent).reshape(4, -1)
            padded = np.hstack([rows, np.full((4, 3), 99, np.uint8)])
            encoding, _, big = name.partition(" ")
            sent = {"data": padded.tobytes(), "big": int(big or 0), "step": padded.shape[1]}
            path = self.bag("mcap", lambda m: m.image(T0, encoding, **sent))
            out, summary = self.converted(path)
            (file,) = (out / "mav0/cam0/data").iterdir()
            with self.subTest(name):
                np.testing.assert_array_equal(netpbm(file).squeeze(), expected)
                self.assertEqual(file.suffix, ".ppm" if expected.ndim == 3 else ".pgm")
                self.assertEqual(summary.get("bayer"), "grbg" if "bayer" in name else None)

    def test_compressed_pictures_are_copied(self):
        path = self.bag("bag", lambda m: (m.compressed(T0, JPEG), m.compressed(T0 + 1, PNG), m.info(T0)))
        out, _ = self.converted(path)
        self.assertEqual((out / f"mav0/cam0/data/{T0}.jpg").read_bytes(), JPEG)
        self.assertEqual((out / f"mav0/cam0/data/{T0 + 1}.png").read_bytes(), PNG)
        self.assertIn("intrinsics", (out / "mav0/cam0/sensor.yaml").read_text())

    def test_receive_times_where_stamps_are_no_use(self):
        for stamps, says in (((0, 0), "are all 0"), ((T0, T0), "do not increase")):
            sent = [(T0 + 9 + i, t) for i, t in enumerate(stamps)]
            path = self.bag("db3", lambda m: [(m.image(t, at=at), m.imu(at)) for at, t in sent])
            out, summary = self.converted(path)
            self.assertTrue(any(says in line for line in summary["told"]), summary)
            self.assertEqual({f.stem for f in (out / "mav0/cam0/data").iterdir()}, {str(T0 + 9), str(T0 + 10)})

    def test_calibrations(self):
        def yaml_of(topic="/cam/image_raw", **info):
            out, summary = self.converted(self.bag("mcap", lambda m: (m.image(T0, topic=topic), m.info(T0, **info))))
            return (out / "mav0/cam0/sensor.yaml").read_text(), " ".join(summary["told"])

        self.assertIn("distortion_model: equidistant", yaml_of(model="equidistant")[0])
        rational = yaml_of(D=range(8), model="rational_polynomial")[0]
        self.assertEqual(numbers_of(rational, "distortion_coefficients"), list(range(8)))
        self.assertIn("distortion_model: none", yaml_of(D=(), model="")[0])
        rectified = yaml_of("/cam/image_rect_color")[0]
        self.assertIn("distortion_model: none", rectified)
        self.assertEqual(numbers_of(rectified, "intrinsics"), [390, 391, 3, 2])
        for info, says in (({"K": [0] * 9}, "not calibrated"), ({"model": "odd"}, "'odd' of 4 numbers")):
            yaml, told = yaml_of(**info)
            self.assertNotIn("intrinsics", yaml)
            self.assertIn(says, told)

    def test_poses_of_tf_and_of_messages_without_a_child(self):
        def fill(m):
            link(m)
            for i in range(5):
                m.image(T0 + i * 10**8)
                m.tf(T0 + i * 10**8, "odom", "base", turn((0, 0, 1), 0.2 * i), (i, 0, 0), "/tf")
                if i % 4 == 0:
                    m.tf(T0 + i * 10**8, "map", "odom", turn((0, 0, 1), 0.1 * i), (0, i, 0), "/tf")
                m.pose_stamped(T0 + i, turn((1, 2, 3), 0.5), (1, 2, 3))

        path = self.bag("bag", fill)
        out, summary = self.converted(path, "--poses-topic", "/tf", "--world-frame", "map")
        lines = (out / "poses.txt").read_text().splitlines()
        self.assertEqual(len((out / "poses.txt").read_text().splitlines()), 5)
        for i, line in enumerate(lines):
            T_MO, T_OB = matrix((0, 0, 1), 0.1 * i, (0, i, 0)), matrix((0, 0, 1), 0.2 * i, (i, 0, 0))
            self.check_pose(line, T_MO @ T_OB @ matrix(*BASE_CAM))
        out, summary = self.converted(path)
        self.assertIn("taken as the camera's", " ".join(summary["told"]))
        self.check_pose((out / "poses.txt").read_text().splitlines()[4], matrix((1, 2, 3), 0.5, (1, 2, 3)))
        self.refused("--world-frame, perhaps map", path, "--poses-topic", "/tf")
        says = "links the frames 'earth' and 'cam_optical'"
        self.refused(says, path, "--poses-topic", "/tf", "--world-frame", "earth")

    def test_unlinked_frames_are_told(self):
        out, summary = self.converted(self.bag("bag", lambda m: (m.image(T0), m.imu(T0), m.info(T0))))
        says = "links the frames 'imu' (IMU) and 'cam_optical' (camera): it has no T_BS"
        self.assertIn(says, " ".join(summary["told"]))
        self.assertNotIn("T_BS", (out / "mav0/cam0/sensor.yaml").read_text())

    def test_refusals(self):
        image = lambda m: m.image(T0)
        second = lambda m: m.image(T0, topic="/right/image_raw")
        info = lambda m: (m.compressed(T0, PNG), m.info(T0), m.info(T0, topic="/cam/image_raw/camera_info"))
        odometry = lambda m: m.odometry(T0, (1, 0, 0, 0), (0, 0, 0))
        for says, calls, words in (
            ("no topic of sensor_msgs/Image", [odometry], ()),
            ("--image-topic, one of /cam/image_raw /right/image_raw", [image, second], ()),
            ("--imu-topic, one of /imu /imu2", [image, lambda m: (m.imu(T0), m.imu(T0, topic="/imu2"))], ()),
            ("has no messages /other", [image], ("--image-topic", "/other")),
            ("encoding 'yuv422'", [lambda m: m.image(T0, "yuv422")], ()),
            ("mono8, 8UC1", [lambda m: m.image(T0, "32FC1")], ()),
            ("format 'tiff'", [lambda m: m.compressed(T0, b"II*\0", format_="tiff")], ()),
            ("several calibrations", [info], ()),
            ("8x4 pixels", [image, lambda m: m.info(T0, size=(8, 4))], ()),
            ("/imu does not measure its angular_velocity", [image, lambda m: m.imu(T0, gyro=-1.0)], ()),
            ("the frames 'base' and 'cam_optical'", [image, odometry], ("--poses-topic", "/odom")),
            ("no message of /cam/image_raw can be read", [lambda m: m.image(T0, step=5)], ()),
            ("already", [image], ("--out", self.folder)),
        ):  # fmt: skip
            with self.subTest(says):
                self.refused(says, self.bag("bag", *calls), *words)
        done = self.refused("several", self.bag("db3", image, second))
        self.assertIn("/right/image_raw", done.stdout)
        self.refused("no such file", self.folder / "none.bag")
        (self.folder / "some.txt").touch()
        self.refused("none of .bag", self.folder / "some.txt")

    def test_damage(self):
        for kind in STORES:
            path = self.whole(kind)
            file = path if kind == "bag" else path / f"{path.name}.{kind}"
            data = file.read_bytes()
            file.write_bytes(data[: len(data) // 2])
            self.refused(path.name, file)

        def fill(m):
            m.image(T0)
            m.raw("/cam/image_raw", "sensor_msgs/Image", T0 + 1, b"\0\1\0\0short")

        _, summary = self.converted(self.bag("mcap", fill))
        says = f"1 messages of /cam/image_raw are unreadable and left out, first at {T0 + 1} ns"
        self.assertIn(says, " ".join(summary["told"]))

    def test_without_rosbags(self):
        done = self.run_script("some.bag", python=(sys.executable, "-I", "-S"))
        self.assertEqual(done.returncode, 3)
        self.assertEqual(done.stderr, "error: some.bag: reading bags needs the Python package rosbags; "
                         f"install it with: {sys.executable} -m pip install rosbags\n")  # fmt: skip

    def test_interrupt(self):
        fifo = self.folder / "endless.bag"
        os.mkfifo(fifo)
        with subprocess.Popen([sys.executable, SCRIPT, fifo], stderr=subprocess.PIPE) as process:
            with fifo.open("wb"):  # waits for the reader
                process.send_signal(signal.SIGINT)
                self.assertEqual((process.wait(60), process.stderr.read()), (130, b""))


if __name__ == "__main__":
    unittest.main()
