#!/usr/bin/env python3
"""Writes the messages of a generated sequence as a rosbag2 of MCAP: write_bag.py MESSAGES SEQUENCE OUT

MESSAGES has a JSON object a line, as message_writers.cpp writes them: first the sensors, then each frame
of each camera. Pictures are taken from the folder SEQUENCE, byte by byte. OUT is a new folder. With
--version alone it prints the version of rosbags. Needs PyPI's rosbags. Lengths are in m, angles in rad.
T_AB, as [x, y, z, qx, qy, qz, qw], is the pose of frame B in frame A.
"""

from __future__ import annotations

import heapq
import json
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any, Iterator

try:
    import numpy as np
    from rosbags.interfaces import (
        Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime)  # fmt: skip
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError:
    print("writing bags needs the Python package rosbags; install it with: "
          f"{sys.executable} -m pip install rosbags==0.11.9", file=sys.stderr)  # fmt: skip
    sys.exit(3)

SECOND_NS = 10**9
UNKNOWN = -1.0  # the first covariance of a quantity that a message does not have
# ROS's own vision_msgs 4, of Humble and later, which rosbags lacks.
VISION = {
    "Point2D": "float64 x\nfloat64 y",
    "Pose2D": "vision_msgs/Point2D position\nfloat64 theta",
    "BoundingBox2D": "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y",
    "ObjectHypothesis": "string class_id\nfloat64 score",
    "ObjectHypothesisWithPose": "vision_msgs/ObjectHypothesis hypothesis\n"
                                "geometry_msgs/PoseWithCovariance pose",
    "Detection2D": "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
                   "vision_msgs/BoundingBox2D bbox\nstring id",
    "Detection2DArray": "std_msgs/Header header\nvision_msgs/Detection2D[] detections",
}  # fmt: skip


class Bag:
    """A bag that is written in the order of time."""

    def __init__(self, writer: Writer) -> None:
        self.store = get_typestore(Stores.ROS2_HUMBLE)
        for name, fields in VISION.items():
            self.store.register(get_types_from_msg(fields, f"vision_msgs/msg/{name}"))
        self._writer = writer
        self._topics: dict[str, Any] = {}
        self._turns: dict[tuple[str, str], list[float]] = {}

    def make(self, kind: str, *fields: object) -> Any:
        return self.store.types[kind.replace("/", "/msg/")](*fields)

    def send(self, t_ns: int, topic: str, message: Any) -> None:
        kind = message.__msgtype__
        if topic not in self._topics:
            kept = QosDurability.TRANSIENT_LOCAL if topic == "/tf_static" else QosDurability.VOLATILE
            no_limit = QosTime(2147483647, 4294967295)
            qos = Qos(QosHistory.KEEP_LAST, 10, QosReliability.RELIABLE, kept, no_limit, no_limit,
                      QosLiveliness.AUTOMATIC, no_limit, False)  # fmt: skip
            self._topics[topic] = self._writer.add_connection(
                topic, kind, typestore=self.store, offered_qos_profiles=[qos])  # fmt: skip
        self._writer.write(self._topics[topic], t_ns, self.store.serialize_cdr(message, kind))

    def header(self, t_ns: int, frame: str) -> Any:
        stamp = self.make("builtin_interfaces/Time", t_ns // SECOND_NS, t_ns % SECOND_NS)
        return self.make("std_msgs/Header", stamp, frame)

    def vector(self, xyz: list[float]) -> Any:
        return self.make("geometry_msgs/Vector3", *map(float, xyz))

    def rotation(self, frame: str, child: str, q: list[float]) -> Any:
        """Of q and -q, which are the same rotation, the one nearer to the last of these frames."""
        last = self._turns.get((frame, child), q)
        if np.dot(q, last) < 0:
            q = [0.0 - x for x in q]  # no -0
        self._turns[frame, child] = q
        return self.make("geometry_msgs/Quaternion", *q)

    def transform(self, t_ns: int, parent: str, child: str, T: list[float]) -> Any:
        rotation = self.rotation(parent, child, T[3:])
        placed = self.make("geometry_msgs/Transform", self.vector(T[:3]), rotation)
        return self.make("geometry_msgs/TransformStamped", self.header(t_ns, parent), child, placed)

    def odometry(self, t_ns: int, frame: str, child: str, T: list[float] | None,
                 linear: list[float], angular: list[float], variances: list[float]) -> Any:  # fmt: skip
        """Velocities are in the child frame. Without T_AB the pose is unknown."""
        x, y, z, *q = T or [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
        pose = self.make("geometry_msgs/Pose", self.make("geometry_msgs/Point", x, y, z),
                         self.rotation(frame, child, q))  # fmt: skip
        of_pose = np.zeros(36)
        of_pose[0] = 0.0 if T else UNKNOWN
        twist = self.make("geometry_msgs/Twist", self.vector(linear), self.vector(angular))
        return self.make(
            "nav_msgs/Odometry", self.header(t_ns, frame), child,
            self.make("geometry_msgs/PoseWithCovariance", pose, of_pose),
            self.make("geometry_msgs/TwistWithCovariance", twist, np.diag(variances).ravel()))  # fmt: skip


def camera_info(bag: Bag, t_ns: int, camera: dict) -> Any:
    fu, fv, cu, cv = camera["intrinsics"]
    K = np.array([fu, 0, cu, 0, fv, cv, 0, 0, 1], dtype=float)
    P = np.array([fu, 0, cu, camera["P_03"], 0, fv, cv, 0, 0, 0, 1, 0], dtype=float)
    return bag.make(
        "sensor_msgs/CameraInfo", bag.header(t_ns, camera["frame"]), camera["height"],
        camera["width"], camera["model"], np.array(camera["distortion"], dtype=float), K,
        np.eye(3).ravel(), P, 0, 0, bag.make("sensor_msgs/RegionOfInterest", 0, 0, 0, 0, False))  # fmt: skip


def detections(bag: Bag, header: Any, boxes: list) -> Any:
    """Boxes of what is seen. Pixels: (0, 0) is the centre of the top-left one."""
    no_pose = bag.odometry(0, "", "", None, [0] * 3, [0] * 3, [0] * 6).pose
    found = []
    for id_, kind, left, top, right, bottom in boxes:
        hypothesis = bag.make("vision_msgs/ObjectHypothesis", kind, 1.0)
        result = bag.make("vision_msgs/ObjectHypothesisWithPose", hypothesis, no_pose)
        centre = bag.make("vision_msgs/Point2D", (left + right - 1) / 2, (top + bottom - 1) / 2)
        box = bag.make("vision_msgs/BoundingBox2D", bag.make("vision_msgs/Pose2D", centre, 0.0),
                       float(right - left), float(bottom - top))  # fmt: skip
        found.append(bag.make("vision_msgs/Detection2D", header, [result], box, str(id_)))
    return bag.make("vision_msgs/Detection2DArray", header, found)


def readings(bag: Bag, sensors: dict, frame: dict) -> Iterator[tuple[int, str, Any]]:
    gyro, accelerometer = (np.diag([v] * 3).ravel().astype(float) for v in sensors["imu_variances"])
    unknown = np.zeros(9)
    unknown[0] = UNKNOWN
    no_attitude = bag.make("geometry_msgs/Quaternion", 0.0, 0.0, 0.0, 1.0)
    for t, *rates in frame["imu"]:
        yield t, "/imu0", bag.make(
            "sensor_msgs/Imu", bag.header(t, "imu"), no_attitude, unknown, bag.vector(rates[:3]),
            gyro, bag.vector(rates[3:]), accelerometer)  # fmt: skip
    for t, *T_WS in frame["states"]:
        moved = bag.transform(t, "world", "imu", T_WS)
        yield t, "/tf", bag.make("tf2_msgs/TFMessage", [moved])
    for t, x, y, z, yaw_rate in frame["wheels"]:
        yield t, "/odometry0", bag.odometry(
            t, "odom", "base", None, [x, y, z], [0, 0, yaw_rate], sensors["wheel_variances"])  # fmt: skip
    truth = frame["truth"]
    t = truth["t"]
    yield t, "/truth/odometry", bag.odometry(
        t, "world", sensors["cameras"][0]["frame"], truth["T_WC"], truth["v_C"], truth["w_C"], [0] * 6)  # fmt: skip


def views(bag: Bag, sensors: dict, folder: Path, frame: dict) -> Iterator[tuple[int, str, Any]]:
    camera, t = sensors["cameras"][frame["place"]], frame["t"]
    header = bag.header(t, camera["frame"])
    data = np.frombuffer((folder / frame["picture"]).read_bytes(), np.uint8)
    name = f"/cam{frame['place']}"
    yield t, f"{name}/image_raw/compressed", bag.make(
        "sensor_msgs/CompressedImage", header, "bgr8; png compressed bgr8", data)  # fmt: skip
    yield t, f"{name}/camera_info", camera_info(bag, t, camera)
    yield t, f"{name}/detections", detections(bag, header, frame["boxes"])


def frames_of(messages: Path, place: int) -> Iterator[dict]:
    """The frames of one camera, in the order of time."""
    with messages.open() as lines:
        next(lines)
        yield from (frame for frame in map(json.loads, lines) if frame["place"] == place)


def write(messages: Path, folder: Path, out: Path) -> None:
    with messages.open() as lines:
        sensors = json.loads(next(lines))
    with Writer(out, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        bag = Bag(writer)
        start = sensors["start"]
        links = [bag.transform(start, "imu", child, T) for child, T in sensors["links"].items()]
        bag.send(start, "/tf_static", bag.make("tf2_msgs/TFMessage", links))
        cameras = [frames_of(messages, place) for place in range(len(sensors["cameras"]))]
        for frame in heapq.merge(*cameras, key=lambda frame: frame["t"]):
            found = list(readings(bag, sensors, frame)) if "imu" in frame else []
            found.sort(key=lambda one: one[0])
            for one in (*found, *views(bag, sensors, folder, frame)):
                bag.send(*one)


def main(words: list[str]) -> int:
    if words == ["--version"]:
        print(version("rosbags"), end="")
        return 0
    try:
        write(*map(Path, words))
        return 0
    except Exception as fault:  # of any type: rosbags passes its libraries' exceptions on
        print(f"the bag was not written ({type(fault).__name__}: {fault})", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
