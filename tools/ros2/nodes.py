#!/usr/bin/env python3
"""Nodes of ROS 2: publish plays a sequence in its time, detect runs the filter on topics.

  nodes.py publish data/crossing    a folder of lcs generate, or another in EuRoC's layout
  nodes.py detect data/crossing     the filter, with the settings in the folder's lcs.json
  nodes.py detect robot.json --ros-args -r /imu0:=/imu      other topics, by ROS's own option

publish waits for subscribers of pictures, IMU and odometry. Its topics: /cam0/image_raw (Image),
/cam0/camera_info, /imu0 (Imu), /odometry0 (Odometry: velocity and yaw rate of the rover) and
/truth/pose (PoseStamped: the IMU in the world). detect answers to each picture by two PointCloud2:
  /lcs/corners   x, y in px, log_odds that it moves, verdict (lcs.Verdict), reason (lcs.Reason)
  /lcs/boxes     left, top, right, bottom: pixel edges, id, moves (0 or 1)
All topics are reliable and keep all: a sender waits for slower readers. Ctrl-C ends a node.
"""

import argparse
import array
import csv
import heapq
import sys
import time
from collections import deque
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator

try:
    import lcs
    import numpy as np
    import rclpy
    import yaml
    from builtin_interfaces.msg import Time
    from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Twist, Vector3
    from nav_msgs.msg import Odometry
    from PIL import Image as Picture
    from rclpy.duration import Duration
    from rclpy.executors import ExternalShutdownException
    from rclpy.node import Node
    from rclpy.qos import QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
    from sensor_msgs.msg import CameraInfo, Image, Imu, PointCloud2, PointField
    from std_msgs.msg import Header
except ImportError as missing:
    print(f"error: {missing}; tools/ros2/README.md says how to install it", file=sys.stderr)
    sys.exit(3)

SECOND_NS, NEVER_NS = 10**9, 2**63
QUIET_S = 2.0  # of the IMU, after which the last pictures have all their readings
MOST_WAITING = 30  # pictures before the IMU's first reading
MOST_LATE_NS = 10**8  # that reading after the first picture
PICTURES, INFO, IMU, WHEELS = "/cam0/image_raw", "/cam0/camera_info", "/imu0", "/odometry0"
NONE_LOST = QoSProfile(reliability=QoSReliabilityPolicy.RELIABLE, history=QoSHistoryPolicy.KEEP_ALL)
CHANNELS = {"bgr8": [0, 1, 2], "rgb8": [2, 1, 0], "mono8": [0, 0, 0]}
MODELS = {"radial-tangential": "plumb_bob", "radtan": "plumb_bob"}  # EuRoC's words and ROS's
FIELDS = {"f4": PointField.FLOAT32, "f8": PointField.FLOAT64, "i4": PointField.INT32,
          "u1": PointField.UINT8}  # fmt: skip


# ---- Messages


def header(t_ns: int, frame: str) -> Header:
    return Header(stamp=Time(sec=t_ns // SECOND_NS, nanosec=t_ns % SECOND_NS), frame_id=frame)


def time_ns(message: Any) -> int:
    return message.header.stamp.sec * SECOND_NS + message.header.stamp.nanosec


def vector(row: list[str]) -> Vector3:
    x, y, z = map(float, row)
    return Vector3(x=x, y=y, z=z)


def imu(t_ns: int, row: list[str]) -> Imu:
    made = Imu(header=header(t_ns, "imu"), angular_velocity=vector(row[:3]),
               linear_acceleration=vector(row[3:6]))  # fmt: skip
    made.orientation_covariance[0] = -1.0  # unknown
    return made


def odometry(t_ns: int, row: list[str]) -> Odometry:
    made = Odometry(header=header(t_ns, "odom"), child_frame_id="base")
    yaw_rate = float([*row, "nan"][3])  # nan: the wheels do not measure it
    made.twist.twist = Twist(linear=vector(row[:3]), angular=Vector3(z=yaw_rate))
    return made


def truth(t_ns: int, row: list[str]) -> PoseStamped:
    x, y, z, qw, qx, qy, qz = map(float, row[:7])
    pose = Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
    return PoseStamped(header=header(t_ns, "world"), pose=pose)


def picture(t_ns: int, file: Path) -> Image:
    with Picture.open(file) as stored:
        seen = stored.convert("RGB")
    return Image(header=header(t_ns, "cam0"), height=seen.height, width=seen.width, encoding="rgb8",
                 step=3 * seen.width, data=array.array("B", seen.tobytes()))  # fmt: skip


def camera_info(t_ns: int, sensor: dict[str, Any]) -> CameraInfo:
    fu, fv, cu, cv = map(float, sensor["intrinsics"])
    width, height = sensor["resolution"]
    model, lens = sensor["distortion_model"], list(map(float, sensor["distortion_coefficients"]))
    lens += [0.0] * (5 - len(lens)) if model in MODELS else []
    return CameraInfo(header=header(t_ns, "cam0"), width=width, height=height, d=lens,
                      distortion_model=MODELS.get(model, model), r=np.eye(3).ravel(),
                      k=[fu, 0.0, cu, 0.0, fv, cv, 0.0, 0.0, 1.0],
                      p=[fu, 0.0, cu, 0.0, 0.0, fv, cv, 0.0, 0.0, 0.0, 1.0, 0.0])  # fmt: skip


def cloud(of: Header, **columns: tuple[str, Any]) -> PointCloud2:
    """A table of columns, each with its type and values."""
    types = [(name, kind) for name, (kind, _) in columns.items()]
    table = np.rec.fromarrays([values for _, values in columns.values()], dtype=types)
    fields = [
        PointField(name=name, offset=table.dtype.fields[name][1], datatype=FIELDS[kind], count=1)
        for name, kind in types
    ]
    return PointCloud2(header=of, height=1, width=len(table), fields=fields, is_dense=True,
                       point_step=table.itemsize, row_step=table.nbytes,
                       data=array.array("B", table.tobytes()))  # fmt: skip


def pixels(message: Image) -> np.ndarray:
    """Height x width x 3: blue, green, red."""
    if message.encoding not in CHANNELS:
        raise ValueError(f"the encoding is {message.encoding}; give one of {', '.join(CHANNELS)}")
    channels = CHANNELS[message.encoding]
    rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    rows = rows[:, : message.width * (1 + max(channels))]
    return rows.reshape(message.height, message.width, -1)[..., channels]


# ---- Nodes


def rows_of(sensor: Path) -> Iterator[tuple[int, list[str]]]:
    """Times in ns and the other columns of a sensor's table; none without the table."""
    if (sensor / "data.csv").exists():
        with (sensor / "data.csv").open(newline="") as lines:
            yield from ((int(row[0]), row[1:]) for row in csv.reader(lines) if row[0][0] != "#")


def publish(node: Node, asked: argparse.Namespace) -> None:
    mav = asked.path / "mav0"
    pictures = list(rows_of(mav / "cam0"))
    if len(pictures) < 2:
        raise lcs.Error(f"{mav}/cam0/data.csv lists no pictures; give a folder of lcs generate")
    sensor = yaml.safe_load((mav / "cam0/sensor.yaml").read_text())
    first, last = pictures[0][0], pictures[-1][0]
    pace = (len(pictures) - 1) * SECOND_NS / (last - first) / asked.rate if asked.rate else 1.0

    def table(kind: type, topic: str, make: Callable[..., Any], rows: Any) -> list[tuple]:
        to = node.create_publisher(kind, topic, NONE_LOST)
        return [(t_ns, to, make, row) for t_ns, row in rows]

    files = ((t_ns, mav / "cam0/data" / row[0]) for t_ns, row in pictures)
    tables = [  # in this order at equal times
        table(Imu, IMU, imu, rows_of(mav / "imu0")),
        table(Odometry, WHEELS, odometry, rows_of(mav / "odometry0")),
        table(Image, PICTURES, picture, files),
        table(CameraInfo, INFO, camera_info, ((t_ns, sensor) for t_ns, _ in pictures)),
        table(PoseStamped, "/truth/pose", truth, rows_of(mav / "state_groundtruth_estimate0")),
    ]
    awaited = [rows[0][1] for rows in tables[:3] if rows]
    print(f"{asked.path} waits for subscribers", flush=True)
    while any(to.get_subscription_count() == 0 for to in awaited):
        rclpy.spin_once(node, timeout_sec=0.05)
    begin = time.monotonic()
    for t_ns, to, make, row in heapq.merge(*tables, key=lambda entry: entry[0]):
        time.sleep(max(0.0, begin + pace * (t_ns - first) / SECOND_NS - time.monotonic()))
        to.publish(make(t_ns, row))
    print(f"sent {len(pictures)} pictures in {time.monotonic() - begin:.2f} s", flush=True)
    for to in (rows[0][1] for rows in tables if rows):
        while not to.wait_for_all_acked(Duration(seconds=1)):
            pass  # a reader is slow


@contextmanager
def naming(topic: str) -> Iterator[None]:
    """Puts the topic before what is wrong with its message."""
    try:
        yield
    except ValueError as fault:
        raise lcs.Error(f"{topic}: {fault}") from fault


class Detector:
    def __init__(self, node: Node, settings: Path) -> None:
        self.live = lcs.Live(settings / "lcs.json" if settings.is_dir() else settings)
        self.filter = lcs.Filter(self.live.scenario)
        self.waiting: deque[Image] = deque()
        self.first_imu_ns, self.heard, self.done = NEVER_NS, 0.0, 0
        self.to_corners = node.create_publisher(PointCloud2, "/lcs/corners", NONE_LOST)
        self.to_boxes = node.create_publisher(PointCloud2, "/lcs/boxes", NONE_LOST)
        node.create_subscription(Imu, IMU, self.take_imu, NONE_LOST)
        node.create_subscription(Odometry, WHEELS, self.take_odometry, NONE_LOST)
        node.create_subscription(Image, PICTURES, self.take_picture, NONE_LOST)

    def take_imu(self, message: Imu) -> None:
        w, a = message.angular_velocity, message.linear_acceleration
        with naming(IMU):
            self.live.add_imu(time_ns(message), [w.x, w.y, w.z], [a.x, a.y, a.z])
        self.first_imu_ns = min(self.first_imu_ns, time_ns(message))
        self.heard = time.monotonic()

    def take_odometry(self, message: Odometry) -> None:
        v, yaw_rate = message.twist.twist.linear, message.twist.twist.angular.z
        known = None if np.isnan(yaw_rate) else yaw_rate
        with naming(WHEELS):
            self.live.add_odometry(time_ns(message), [v.x, v.y, v.z], known)

    def take_picture(self, message: Image) -> None:
        self.waiting.append(message)

    def work(self) -> None:
        """Filters each picture that has all its readings."""
        if self.waiting and self.first_imu_ns - time_ns(self.waiting[0]) > MOST_LATE_NS:
            if self.heard or len(self.waiting) > MOST_WAITING:
                raise lcs.Error(
                    f"{IMU}: no reading before the first picture of {PICTURES}; start it first, "
                    f"or give its topic: --ros-args -r {IMU}:=NAME"
                )
        is_quiet = self.heard and time.monotonic() - self.heard > QUIET_S
        while self.waiting and (is_quiet or self.live.is_due(time_ns(self.waiting[0]))):
            self.step(self.waiting.popleft())

    def step(self, message: Image) -> None:
        with naming(PICTURES):
            frame = self.live.frame(time_ns(message), pixels(message))
        said = self.filter.step(frame.corners, frame.motion, frame.signatures, picture=frame.grey)
        odds = said.log_odds if len(said.log_odds) else np.full(len(frame.corners), np.nan)
        (x, y), (left, top, right, bottom) = frame.corners.T, said.boxes.T
        moves = said.squares["rebel_circles"] > 0
        self.to_corners.publish(cloud(
            message.header, x=("f4", x), y=("f4", y), log_odds=("f4", odds),
            verdict=("u1", said.verdicts), reason=("u1", said.reasons)))  # fmt: skip
        self.to_boxes.publish(cloud(
            message.header, left=("f8", left), top=("f8", top), right=("f8", right),
            bottom=("f8", bottom), id=("i4", said.squares["id"]), moves=("u1", moves)))  # fmt: skip
        self.done += 1


def detect(node: Node, asked: argparse.Namespace) -> None:
    detector = Detector(node, asked.path)
    try:
        while True:
            rclpy.spin_once(node, timeout_sec=0.2)
            detector.work()
    finally:
        print(f"{detector.done} pictures", *detector.live.diagnostics, *detector.filter.diagnostics,
              sep="\n", flush=True)  # fmt: skip


def main() -> int:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw, allow_abbrev=False)
    parser.add_argument("node", choices=("publish", "detect"))
    parser.add_argument("path", type=Path, help="folder of a sequence, or for detect its lcs.json")
    parser.add_argument("--rate", type=float, metavar="HZ",
                        help="pictures a second, with the stamps as recorded")  # fmt: skip
    asked, words = parser.parse_known_args()  # the others are ROS's
    rclpy.init(args=[sys.argv[0], *words])
    try:
        work = publish if asked.node == "publish" else detect
        work(rclpy.create_node(f"lcs_{asked.node}"), asked)
        return 0
    except (KeyboardInterrupt, ExternalShutdownException):
        return 130
    except (lcs.Error, OSError) as refusal:
        print(f"error: {refusal}", file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
