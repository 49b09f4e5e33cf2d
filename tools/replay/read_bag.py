#!/usr/bin/env python3
"""A recording of ROS 1 or ROS 2 as a folder in EuRoC's ASL layout: read_bag.py BAG [--out DIR ...]

BAG is a .bag, .db3 or .mcap, or a folder of rosbag2. Without --out it prints the topics. Needs
PyPI's rosbags. T_AB is the pose of frame B in frame A: it takes B's coordinates to A's.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import shutil
import statistics
import struct
import sys
from array import array
from bisect import bisect_left
from pathlib import Path
from typing import Any, Callable, Iterator, NamedTuple

try:
    import numpy as np
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    HAS_ROSBAGS = True
except ImportError:
    HAS_ROSBAGS = False
except KeyboardInterrupt:
    sys.exit(130)

SECOND_NS = 10**9
TF = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
KINDS = {
    "image": ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"),
    "imu": ("sensor_msgs/msg/Imu",),
    "camera-info": ("sensor_msgs/msg/CameraInfo",),
    "poses": ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped",
              "geometry_msgs/msg/TransformStamped", "nav_msgs/msg/Odometry", *TF),
    "odometry": ("nav_msgs/msg/Odometry",),
}  # fmt: skip
REMEDIES = {
    ".bag": "'rosbag reindex' repairs a bag that was cut short",
    ".mcap": "'mcap recover' repairs a file that was cut short",
    ".db3": "'sqlite3 FILE .recover' saves the rows that are whole",
    "": "'ros2 bag reindex' makes its metadata.yaml anew",
}
# Encoding: channels, those of red, green and blue (or of grey), bytes of a channel.
ENCODINGS = {
    "mono8": (1, [0], 1), "8UC1": (1, [0], 1), "mono16": (1, [0], 2), "16UC1": (1, [0], 2),
    "rgb8": (3, [0, 1, 2], 1), "bgr8": (3, [2, 1, 0], 1), "8UC3": (3, [2, 1, 0], 1),
    "rgba8": (4, [0, 1, 2], 1), "bgra8": (4, [2, 1, 0], 1),
    **{f"bayer_{pattern}8": (1, [0], 1) for pattern in ("rggb", "bggr", "gbrg", "grbg")},
}  # fmt: skip
JPEG, PNG = b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n"
IMU_HEADER = (
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]"
)
ODOMETRY_HEADER = (
    "#timestamp [ns],v_RB_B_x [m s^-1],v_RB_B_y [m s^-1],v_RB_B_z [m s^-1],w_RB_B_z [rad s^-1]"
)


class Refusal(Exception):
    """A fault of the input, as "what; remedy"."""


class Topic(NamedTuple):
    name: str
    type: str
    messages: int


class Pose(NamedTuple):
    """T_AB: q is a unit quaternion w x y z, p a position in metres."""

    q: np.ndarray
    p: np.ndarray

    def rotation(self) -> np.ndarray:
        w, x, y, z = self.q
        return np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ])  # fmt: skip

    def __matmul__(self, other: Pose) -> Pose:
        w, v, other_w, other_v = self.q[0], self.q[1:], other.q[0], other.q[1:]
        q = np.array([w * other_w - v @ other_v, *(w * other_v + other_w * v + np.cross(v, other_v))])
        return Pose(q, self.p + self.rotation() @ other.p)

    def inverse(self) -> Pose:
        turn = Pose(self.q * [1, -1, -1, -1], np.zeros(3))
        return turn._replace(p=-(turn.rotation() @ self.p))


Edge = tuple  # (A, B) of a T_AB in tf: names of the parent and the child


def identity() -> Pose:
    return Pose(np.array([1.0, 0, 0, 0]), np.zeros(3))


def pose_of(position: Any, orientation: Any) -> Pose:
    q = np.array([orientation.w, orientation.x, orientation.y, orientation.z])
    p = np.array([position.x, position.y, position.z])
    length = np.linalg.norm(q)
    if not (abs(length - 1) < 1e-2 and np.isfinite(p).all()):
        raise ValueError("the pose has no unit quaternion or no finite position")
    return Pose(q / length, p)


def one_line(text: object) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in str(text)).split())


def fault_of(fault: BaseException) -> str:
    return one_line(fault)[:150].rstrip(". ") or type(fault).__name__


def shown(type_: str) -> str:
    return one_line(type_).replace("/msg/", "/")


def frame_of(name: str) -> str:
    """Old releases of tf begin a name with a slash, new ones do not."""
    return name.lstrip("/")


def stamp_of(header: Any) -> int:
    """The header's time in ns."""
    if header.stamp.sec < 0 or not 0 <= header.stamp.nanosec < SECOND_NS:
        raise ValueError("the header's stamp is no time")
    return header.stamp.sec * SECOND_NS + header.stamp.nanosec


class Bag:
    """The messages of a bag, in the order of their receive times. A fault that leaves some of them
    out, and whatever is assumed, becomes a line of `told`."""

    def __init__(self, path: Path, stack: contextlib.ExitStack) -> None:
        self.told: list[str] = []
        self._readers: list[Any] = []
        self._stores: dict[str, Any] = {}
        counts: dict[tuple[str, str], int] = {}
        parts = self._parts(path)
        try:
            for part in parts:
                reader = Reader1(part) if part.suffix == ".bag" else Reader2(part)
                self._readers.append(stack.enter_context(reader))
                wal = Path(f"{part}-wal")
                if wal.is_file() and wal.stat().st_size:
                    self.tell(f"the messages in {wal.name} are left out: SQLite has not joined them")
            self._connections = [(r, c) for r in self._readers for c in r.connections]
            for _, c in self._connections:
                key = (str(c.topic), str(c.msgtype))
                counts[key] = counts.get(key, 0) + int(c.msgcount)
        except Exception as fault:  # of any kind: rosbags passes those of its libraries on
            remedy = REMEDIES["" if path.is_dir() else path.suffix]
            raise Refusal(f"cannot be read as a bag: {fault_of(fault)}; {remedy}") from None
        self.topics = [Topic(*key, count) for key, count in sorted(counts.items())]

    @staticmethod
    def _parts(path: Path) -> list[Path]:
        if not path.exists():
            raise Refusal("there is no such file; give a .bag, .db3, .mcap or a folder of rosbag2")
        if not path.is_dir():
            if path.suffix in REMEDIES and path.suffix:
                return [path]
            raise Refusal("its name ends in none of .bag, .db3, .mcap; give one of these")
        if (path / "metadata.yaml").exists():
            return [path]
        files = [file for file in path.iterdir() if file.suffix in (".db3", ".mcap")]
        if not files:
            raise Refusal("the folder has no metadata.yaml, .db3 or .mcap; give one of rosbag2")
        return sorted(files, key=lambda file: (len(file.name), file.name))

    def tell(self, line: str) -> None:
        if one_line(line) not in self.told:
            self.told.append(one_line(line))

    def messages(self, topics: list[Topic], start_ns: int | None = None) -> Iterator[tuple]:
        """Topic, receive time in ns and bytes of each message; ends where the bag cannot be read."""
        wanted = {topic[:2]: topic for topic in topics}
        for reader in self._readers:
            mine = [c for r, c in self._connections if r is reader and (c.topic, c.msgtype) in wanted]
            try:
                for c, t_ns, data in reader.messages(mine, start=start_ns) if mine else ():
                    if isinstance(t_ns, int):
                        yield wanted[(c.topic, c.msgtype)], t_ns, data
                    else:  # SQLite's columns can hold any type
                        self.tell(f"messages of {c.topic} have no receive time and are left out")
            except Exception as fault:
                self.tell(f"the bag is read up to a fault, and no further: {fault_of(fault)}")

    def _parse(self, topic: Topic, data: bytes) -> Any:
        is_ros1 = isinstance(self._readers[0], Reader1)
        if topic.type not in self._stores:
            self._stores[topic.type] = self._store_of(topic, is_ros1)
        store = self._stores[topic.type]
        return (store.deserialize_ros1 if is_ros1 else store.deserialize_cdr)(data, topic.type)

    def _store_of(self, topic: Topic, is_ros1: bool) -> Any:
        """The bag's definition of a type, or that of ROS."""
        for _, connection in self._connections:
            if connection.msgtype != topic.type or connection.msgdef.format.name != "MSG":
                continue
            try:
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(connection.msgdef.data, topic.type))
                store.get_msgdef(topic.type)
                return store
            except Exception:
                self.tell(f"the bag's definition of {shown(topic.type)} is damaged; ROS's is used")
        return get_typestore(Stores.ROS1_NOETIC if is_ros1 else Stores.ROS2_HUMBLE)

    def read(self, handlers: dict[Topic, Callable[[Any, int], Any]]) -> None:
        """Passes each message and its receive time to its topic's handler. Counts and leaves out
        those that are damaged: rosbags or the handler raises."""
        left_out: dict[Topic, tuple[int, str]] = {}
        for topic, t_ns, data in self.messages(list(handlers)):
            try:
                handlers[topic](self._parse(topic, data), t_ns)
            except (Refusal, OSError):
                raise
            except Exception as fault:
                count, first = left_out.get(topic, (0, f"at {t_ns} ns: {fault_of(fault)}"))
                left_out[topic] = (count + 1, first)
        for topic, (count, first) in left_out.items():
            self.tell(f"{count} messages of {topic.name} are unreadable and left out, first {first}")

    def span_ns(self, topic: Topic) -> int:
        """Time from the first message to the last; seeks the last in ever longer ends of the bag."""
        first = next((t_ns for _, t_ns, _ in self.messages([topic])), 0)
        end = max(reader.end_time for reader in self._readers)
        back, last = SECOND_NS, None
        while last is None and end - back > first:
            last = max((t_ns for _, t_ns, _ in self.messages([topic], end - back)), default=None)
            back *= 16
        if last is None:
            last = max((t_ns for _, t_ns, _ in self.messages([topic])), default=first)
        return last - first


def transforms_in(message: Any) -> Iterator[tuple[Edge, int, Pose]]:
    """Frames, stamp in ns and T_AB of each valid transform."""
    for one in message.transforms:
        with contextlib.suppress(ValueError):
            T_AB = pose_of(one.transform.translation, one.transform.rotation)
            edge = (frame_of(one.header.frame_id), frame_of(one.child_frame_id))
            yield edge, stamp_of(one.header), T_AB


class Frames:
    """The transforms of tf: the static ones, and the first and the moving of the others."""

    def __init__(self, bag: Bag) -> None:
        self._bag = bag
        self._static: dict[Edge, Pose] = {}
        self._timed: dict[Edge, Pose] = {}
        self._moving: set[Edge] = set()
        topics = [topic for topic in bag.topics if topic.type in TF]
        bag.read({t: self._fix if t.name.endswith("tf_static") else self._watch for t in topics})

    def _fix(self, message: Any, _: int) -> None:
        for edge, _, T_AB in transforms_in(message):
            self._static[edge] = T_AB

    def _watch(self, message: Any, _: int) -> None:
        for edge, _, T_AB in transforms_in(message):
            first = self._timed.setdefault(edge, T_AB)
            if max(abs(first.p - T_AB.p)) > 1e-6 or abs(first.q @ T_AB.q) < 1 - 1e-12:
                self._moving.add(edge)

    def path(self, start: str, goal: str, rigid: bool) -> list[tuple[Edge, bool]] | None:
        """The edges from start to goal, each with whether it leads from parent to child."""
        near: dict[str, list] = {}
        for edge in {**self._timed, **self._static}:
            if not rigid or edge in self._static or edge not in self._moving:
                near.setdefault(edge[0], []).append((edge[1], (edge, True)))
                near.setdefault(edge[1], []).append((edge[0], (edge, False)))
        paths: dict[str, list] = {start: []}
        queue = [start]
        for frame in queue:  # grows in the loop
            for other, step in near.get(frame, []):
                if other not in paths:
                    paths[other] = paths[frame] + [step]
                    queue.append(other)
        return paths.get(goal)

    def rigid(self, a: str, b: str) -> Pose | None:
        """T_AB, absent unless transforms that never change link the two."""
        path = self.path(a, b, rigid=True) if a and b else None
        return None if path is None else along(path, {**self._timed, **self._static}.get)

    def poses(self, world: str | None, camera: str, by_stamp: bool) -> list[tuple[int, Pose]]:
        """Times in ns and T_WC, at the times of the fastest moving transform between the two."""
        if world is None:
            roots = sorted({a for a, _ in self._timed} - {b for _, b in self._timed})
            raise Refusal(f"tf has many frames; give --world-frame, perhaps {' or '.join(roots[:5])}")
        path = self.path(frame_of(world), camera, rigid=False) or []
        timed = [edge for edge, _ in path if edge not in self._static]
        if not timed:
            raise Refusal(f"no moving transform of tf links the frames {world!r} and {camera!r} "
                          "(camera); give another --world-frame")  # fmt: skip
        series: dict[Edge, dict[int, Pose]] = {edge: {} for edge in timed}

        def read(message: Any, t_ns: int) -> None:
            for edge, stamp, T_AB in transforms_in(message):
                if edge in series:
                    series[edge].setdefault(stamp if by_stamp else t_ns, T_AB)

        self._bag.read({topic: read for topic in self._bag.topics if topic.type in TF})
        times = {edge: sorted(poses) for edge, poses in series.items()}
        fixed = {**self._timed, **self._static}
        pace = max(timed, key=lambda edge: (edge in self._moving, len(times[edge])))

        def T_at(t_ns: int) -> Pose | None:
            return along(path, lambda edge: between(times[edge], series[edge], t_ns)
                         if edge in timed and edge in self._moving else fixed[edge])  # fmt: skip

        return [(t_ns, T_WC) for t_ns in times[pace] if (T_WC := T_at(t_ns)) is not None]


def along(path: list[tuple[Edge, bool]], T_of: Callable[[Edge], Pose | None]) -> Pose | None:
    T = identity()
    for edge, is_forward in path:
        step = T_of(edge)
        if step is None:
            return None
        T = T @ (step if is_forward else step.inverse())
    return T


def between(times: list[int], poses: dict[int, Pose], t_ns: int) -> Pose | None:
    """The pose at a time, absent outside the times."""
    if t_ns in poses:
        return poses[t_ns]
    after = bisect_left(times, t_ns)
    if after in (0, len(times)):
        return None
    before_ns, after_ns = times[after - 1], times[after]
    share = (t_ns - before_ns) / (after_ns - before_ns)
    one, two = poses[before_ns], poses[after_ns]
    cosine = one.q @ two.q
    angle = math.acos(min(abs(cosine), 1.0))
    a, b = 1 - share, share
    if angle > 1e-6:
        a, b = math.sin(a * angle), math.sin(b * angle)
    q = a * one.q + math.copysign(b, cosine) * two.q
    return Pose(q / np.linalg.norm(q), (1 - share) * one.p + share * two.p)


class Series:
    """The rows of a topic's messages with both times of each in ns, and the frames they name."""

    def __init__(self, topic: Topic, row_of: Callable[[Any], tuple]) -> None:
        self.topic, self._row_of = topic, row_of
        self.stamps, self.received, self._numbers = array("q"), array("q"), array("d")
        self.frame = ""
        self.child: str | None = None  # absent from messages of a type without it

    def read(self, message: Any, t_ns: int) -> None:
        self.add(message, t_ns, self._row_of(message))

    def add(self, message: Any, t_ns: int, row: tuple) -> None:
        child = getattr(message, "child_frame_id", None)
        frames = frame_of(message.header.frame_id), child if child is None else frame_of(child)
        stamp, numbers = array("q", [stamp_of(message.header)]), array("d", row)
        received = array("q", [t_ns])
        if not self.stamps:
            self.frame, self.child = frames
        elif frames != (self.frame, self.child):
            raise ValueError("it is of another frame than the first message")
        self.stamps += stamp
        self.received += received
        self._numbers += numbers

    def times(self, by_stamp: bool) -> array:
        return self.stamps if by_stamp else self.received

    def rows(self) -> Iterator[array]:
        width = len(self._numbers) // max(len(self.stamps), 1)
        return (self._numbers[i : i + width] for i in range(0, len(self._numbers), width or 1))


def imu_row(message: Any, topic: str) -> tuple:
    """Angular rate in rad/s and acceleration in m/s^2, in the IMU's frame."""
    for name in ("angular_velocity", "linear_acceleration"):
        if getattr(message, f"{name}_covariance")[0] == -1:
            raise Refusal(f"{topic} does not measure its {name}, whose covariance is -1; "
                          "give another --imu-topic")  # fmt: skip
    w, a = message.angular_velocity, message.linear_acceleration
    return w.x, w.y, w.z, a.x, a.y, a.z


def odometry_row(message: Any) -> tuple:
    """Velocity in m/s and yaw rate in rad/s, in the child frame."""
    twist = message.twist.twist
    return twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z


def pose_row(message: Any) -> tuple:
    """The pose of the child in the header's frame: quaternion w x y z and metres."""
    if hasattr(message, "transform"):
        pose = pose_of(message.transform.translation, message.transform.rotation)
    else:
        pose = getattr(message.pose, "pose", message.pose)
        pose = pose_of(pose.position, pose.orientation)
    return (*pose.q, *pose.p)


def png_or_jpeg_size(data: bytes) -> tuple[int, int] | None:
    """Width and height in pixels."""
    if data.startswith(PNG):
        return struct.unpack(">II", data[16:24]) if len(data) >= 24 else None
    at = 2
    while at + 9 <= len(data):
        marker, length = struct.unpack(">xBH", data[at : at + 4])
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack(">HH", data[at + 5 : at + 9])
            return width, height
        at += 1 if marker == 0xFF else 2 + length
    return None


def netpbm(message: Any) -> bytes:
    """A PGM or PPM of a sensor_msgs/Image whose encoding is known."""
    channels, order, size = ENCODINGS[message.encoding]
    width, height, step = message.width, message.height, message.step
    row_bytes = width * channels * size
    data = np.frombuffer(message.data, np.uint8)
    if not (row_bytes and height and step >= row_bytes):
        raise ValueError(f"{width}x{height} pixels have rows of {step} bytes")
    if data.size < step * (height - 1) + row_bytes:
        raise ValueError(f"{data.size} bytes are too few for {width}x{height} pixels")
    rows = np.lib.stride_tricks.as_strided(data, (height, row_bytes), (step, 1))
    if size == 2:
        pixels = np.ascontiguousarray(rows).view(">u2" if message.is_bigendian else "<u2").astype(">u2")
    else:
        pixels = rows.reshape(height, width, channels)[:, :, order]
    magic, most = ("P6" if len(order) == 3 else "P5"), (255 if size == 1 else 65535)
    return f"{magic}\n{width} {height}\n{most}\n".encode() + pixels.tobytes()


class Pictures(Series):
    """Writes each picture when it comes; its name is its place until the clock is known."""

    def __init__(self, topic: Topic, folder: Path) -> None:
        super().__init__(topic, lambda _: ())
        self._folder, self.encoding = folder, ""
        self._kinds: list[str] = []
        self.size: tuple[int, int] | None = None
        folder.mkdir(parents=True)

    def read(self, message: Any, t_ns: int) -> None:
        if self.topic.type.endswith("/Image"):
            if message.encoding not in ENCODINGS:
                self._refuse(f"encoding {message.encoding!r}", ENCODINGS)
            encoding, data, size = message.encoding, netpbm(message), (message.width, message.height)
            kind = "ppm" if data.startswith(b"P6") else "pgm"
        else:
            encoding, data = "", message.data.tobytes()
            if not data.startswith((JPEG, PNG)):
                self._refuse(f"format {message.format!r}", ("JPEG", "PNG"))
            kind, size = ("png" if data.startswith(PNG) else "jpg"), png_or_jpeg_size(data)
        self.add(message, t_ns, ())
        if not self._kinds:
            self.encoding, self.size = encoding, size
        (self._folder / f"{len(self._kinds)}.part").write_bytes(data)
        self._kinds.append(kind)

    def _refuse(self, what: str, known: Any) -> None:
        if self._kinds:
            raise ValueError(f"the {what} cannot be read")
        raise Refusal(f"{self.topic.name} has pictures of the {what}; give one of {', '.join(known)}")

    def write(self, by_stamp: bool, bag: Bag) -> None:
        """Names the files by their times."""
        names: dict[int, str] = {}
        for i, (t_ns, kind) in enumerate(zip(self.times(by_stamp), self._kinds)):
            part = self._folder / f"{i}.part"
            if t_ns in names:
                part.unlink()
            else:
                names[t_ns] = part.rename(self._folder / f"{t_ns}.{kind}").name
        if len(names) < len(self._kinds):
            count = len(self._kinds) - len(names)
            bag.tell(f"{count} pictures have the time of one before and are left out")
        rows = [f"{t_ns},{name}\n" for t_ns, name in names.items()]
        (self._folder.parent / "data.csv").write_text("#timestamp [ns],filename\n" + "".join(rows))


class Lens(NamedTuple):
    """A calibration: the numbers of a CameraInfo."""

    frame: str
    size: tuple[int, int]
    model: str
    K: list[float]
    P: list[float]
    D: list[float]

    @staticmethod
    def of(info: Any) -> Lens:
        names = [name if hasattr(info, name) else name.lower() for name in "KPD"]  # of ROS 1 or 2
        numbers = [[float(value) for value in getattr(info, name)] for name in names]
        frame = frame_of(info.header.frame_id)
        return Lens(frame, (info.width, info.height), info.distortion_model.lower(), *numbers)

    def yaml(self, topic: str, pictures: Pictures, bag: Bag) -> list[str]:
        """Lines of a sensor.yaml; none for a camera that is not calibrated."""
        if pictures.size and pictures.size != self.size:
            width, height = pictures.size
            raise Refusal(f"{topic} is of {self.size[0]}x{self.size[1]} pixels, the pictures have "
                          f"{width}x{height}; give another --camera-info-topic")  # fmt: skip
        K, P, D = self.K, self.P, self.D
        is_rectified = "image_rect" in pictures.topic.name
        intrinsics = [P[0], P[5], P[2], P[6]] if is_rectified else [K[0], K[4], K[2], K[5]]
        if not (all(map(math.isfinite, intrinsics + D)) and min(intrinsics[:2]) > 0):
            bag.tell(f"{topic}: the camera is not calibrated, its matrix has no focal length")
            return []
        lines = [f"resolution: {list(self.size)}", "camera_model: pinhole", f"intrinsics: {intrinsics}"]
        if self.model in ("plumb_bob", "rational_polynomial") and len(D) in (4, 5, 8, 12, 14):
            model = "radial-tangential"
        elif self.model in ("equidistant", "fisheye") and len(D) == 4:
            model = "equidistant"
        elif is_rectified or not any(D):
            model = "none"
        else:
            bag.tell(f"{topic}: no calibration for the distortion {self.model!r} of {len(D)} numbers")
            return []
        if is_rectified or not D:
            return [*lines, "distortion_model: none"]
        return [*lines, f"distortion_model: {model}", f"distortion_coefficients: {D}"]


def sensor_yaml(kind: str, T_BS: Pose | None, times: array) -> list[str]:
    lines = [f"sensor_type: {kind}"]
    if T_BS is not None:
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = T_BS.rotation(), T_BS.p
        lines += ["T_BS:", "  cols: 4", "  rows: 4", f"  data: {matrix.ravel().tolist()}"]
    periods = [after - before for before, after in zip(times, times[1:]) if after > before]
    if periods:
        lines.append(f"rate_hz: {round(SECOND_NS / statistics.median(periods), 6)}")
    return lines


def found(bag: Bag, kind: str) -> list[Topic]:
    return [topic for topic in bag.topics if topic.type in KINDS[kind] and topic.messages]


def names_of(topics: list[Topic]) -> str:
    return one_line("  ".join(topic.name for topic in topics))


def named(bag: Bag, kind: str, name: str | None) -> Topic | None:
    if name is None:
        return None
    topics = found(bag, kind)
    for topic in topics:
        if frame_of(topic.name) == frame_of(name):
            return topic
    have = f"one of {names_of(topics)}" if topics else "another bag, as this one has none of its types"
    raise Refusal(f"has no messages {name} of {', '.join(map(shown, KINDS[kind]))}; give {have}")


def only(bag: Bag, kind: str) -> Topic | None:
    """The one topic of a kind; of tf only a named one counts."""
    topics = [topic for topic in found(bag, kind) if topic.type not in TF]
    if len(topics) > 1:
        print_topics(bag)
        raise Refusal(f"has several topics that fit; give --{kind}-topic, one of {names_of(topics)}")
    for topic in topics:
        bag.tell(f"--{kind}-topic is {topic.name}, the only one")
    return topics[0] if topics else None


def beside(bag: Bag, image: Topic) -> Topic | None:
    """The calibration beside the pictures, by ROS's convention."""
    parent = image.name.rpartition("/")[0]
    places = {f"{parent}/camera_info"}
    if image.name.endswith("/compressed"):
        places.add(f"{parent.rpartition('/')[0]}/camera_info")
    every = found(bag, "camera-info")
    topics = [topic for topic in every if topic.name in places]
    if len(topics) > 1:
        raise Refusal(f"has several calibrations; give --camera-info-topic, one of {names_of(topics)}")
    if not topics:
        others = f"; --camera-info-topic can be {names_of(every)}" if every else ""
        bag.tell(f"no camera_info is beside {image.name}{others}")
    return topics[0] if topics else None


def uses_stamps(pictures: Pictures, others: list[Series], bag: Bag) -> bool:
    """Whether times are those of the headers. All topics have the same clock."""
    for series in [pictures, *others]:
        if not any(series.stamps):
            fault = "are all 0"
        elif series is pictures and any(b <= a for a, b in zip(series.stamps, series.stamps[1:])):
            fault = "do not increase"
        else:
            continue
        bag.tell(f"the header stamps of {series.topic.name} {fault}: all times are receive times")
        return False
    return True


@contextlib.contextmanager
def whole_or_nothing(out: Path) -> Iterator[None]:
    """Empties a new or empty folder again if the block fails."""
    is_there = out.exists()
    if is_there and (not out.is_dir() or any(out.iterdir())):
        raise Refusal(f"{out} is there already; give a new or empty folder as --out")
    out.mkdir(parents=True, exist_ok=True)
    try:
        yield
    except BaseException:
        for child in out.iterdir():
            shutil.rmtree(child) if child.is_dir() else child.unlink()
        if not is_there:
            out.rmdir()
        raise


class Recording:
    """The topics of a bag that make a recording, and the folder of it."""

    def __init__(self, bag: Bag, asked: argparse.Namespace) -> None:
        self.bag, self.asked, self.mav = bag, asked, asked.out / "mav0"
        image = named(bag, "image", asked.image_topic) or only(bag, "image")
        if image is None:
            raise Refusal("has no topic of sensor_msgs/Image or CompressedImage; give one that has")
        imu = named(bag, "imu", asked.imu_topic)
        self.pose_topic = named(bag, "poses", asked.poses_topic)
        odometry = named(bag, "odometry", asked.odometry_topic)
        if not imu and not self.pose_topic:
            imu = only(bag, "imu")
            self.pose_topic = None if imu else only(bag, "poses")
            if not imu and not self.pose_topic:
                bag.tell("no topic says how the camera moves")
        self.image = image
        self.info_topic = named(bag, "camera-info", asked.camera_info_topic) or beside(bag, image)
        self.imu = Series(imu, lambda message: imu_row(message, imu.name)) if imu else None
        self.odometry = Series(odometry, odometry_row) if odometry else None
        is_series = self.pose_topic and self.pose_topic.type not in TF
        self.poses = Series(self.pose_topic, pose_row) if is_series else None
        self.lens: Lens | None = None

    def write(self) -> None:
        pictures = Pictures(self.image, self.mav / "cam0" / "data")
        others = [series for series in (self.imu, self.odometry, self.poses) if series]
        self._read(pictures, others)
        by_stamp = uses_stamps(pictures, others, self.bag)
        frames = Frames(self.bag)
        camera = pictures.frame or (self.lens.frame if self.lens else "")
        if "optical" not in camera:
            self.bag.tell(f"the frame {camera!r} is taken as the optical one: x right, z ahead")
        pictures.write(by_stamp, self.bag)
        self._write_camera(pictures, self._T_SX(frames, camera, "camera"), by_stamp)
        if self.imu:
            self._write_rows(self.imu, "imu", IMU_HEADER, identity(), by_stamp)
        if self.odometry:
            T_SB = self._T_SX(frames, self.odometry.child or "", "odometry")
            self._write_rows(self.odometry, "odometry", ODOMETRY_HEADER, T_SB, by_stamp)
        self._write_poses(frames, camera, by_stamp)
        is_bayer = pictures.encoding.startswith("bayer_")
        summary = {
            "told": self.bag.told,
            **({"bayer": pictures.encoding[6:10]} if is_bayer else {}),
        }
        (self.asked.out / "bag.json").write_text(json.dumps(summary, indent=2) + "\n")

    def _read(self, pictures: Pictures, others: list[Series]) -> None:
        readers: dict[Topic, list[Callable[[Any, int], None]]] = {}
        for series in [pictures, *others]:
            readers.setdefault(series.topic, []).append(series.read)
        if self.info_topic:
            readers[self.info_topic] = [self._keep_lens]

        def reader(topic: Topic) -> Callable[[Any, int], Any]:
            return lambda message, t_ns: [read(message, t_ns) for read in readers[topic]]

        self.bag.read({topic: reader(topic) for topic in readers})
        for series in [pictures, *others]:
            if not series.stamps:
                name = series.topic.name
                faults = (f" {name} are unreadable", "read up to a fault")
                lines = [line for line in self.bag.told if any(fault in line for fault in faults)]
                why = (lines or ["there is none"])[0]
                raise Refusal(f"no message of {name} can be read ({why}); give another topic")
        if pictures.encoding == "8UC3":
            self.bag.tell(f"{pictures.topic.name}: 8UC3 is taken as BGR")

    def _keep_lens(self, message: Any, _: int) -> None:
        lens = Lens.of(message)
        self.lens = self.lens or lens
        if str(lens) != str(self.lens):
            self.bag.tell(f"{self.info_topic.name} changes; its first calibration is used")

    def _T_SX(self, frames: Frames, other: str, what: str) -> Pose | None:
        """The pose of a sensor's frame X in the IMU's frame S."""
        T_SX = frames.rigid(self.imu.frame, other) if self.imu else None
        if self.imu and T_SX is None:
            self.bag.tell(f"no fixed transform of tf links the frames {self.imu.frame!r} (IMU) and "
                          f"{other!r} ({what}): it has no T_BS")  # fmt: skip
        return T_SX

    def _write_camera(self, pictures: Pictures, T_SC: Pose | None, by_stamp: bool) -> None:
        if not self.lens and T_SC is None:
            return
        lens = self.lens.yaml(self.info_topic.name, pictures, self.bag) if self.lens else []
        lines = sensor_yaml("camera", T_SC, pictures.times(by_stamp)) + lens
        (self.mav / "cam0" / "sensor.yaml").write_text("\n".join(lines) + "\n")

    def _write_rows(self, series: Series, kind: str, header: str, T_BS: Pose | None,
                    by_stamp: bool) -> None:  # fmt: skip
        folder = self.mav / f"{kind}0"
        folder.mkdir()
        with (folder / "data.csv").open("w") as out:
            out.write(header + "\n")
            for t_ns, row in zip(series.times(by_stamp), series.rows()):
                out.write(f"{t_ns},{','.join(map(repr, row))}\n")
        lines = sensor_yaml(kind, T_BS, series.times(by_stamp))
        (folder / "sensor.yaml").write_text("\n".join(lines) + "\n")

    def _write_poses(self, frames: Frames, camera: str, by_stamp: bool) -> None:
        if not self.pose_topic:
            return
        poses = (self._camera_poses(frames, camera, by_stamp) if self.poses
                 else frames.poses(self.asked.world_frame, camera, by_stamp))  # fmt: skip
        with (self.asked.out / "poses.txt").open("w") as out:
            for t_ns, (q, p) in poses:
                numbers = " ".join(map(repr, [*p.tolist(), *q[1:].tolist(), float(q[0])]))
                out.write(f"{t_ns // SECOND_NS}.{t_ns % SECOND_NS:09d} {numbers}\n")

    def _camera_poses(self, frames: Frames, camera: str, by_stamp: bool) -> list[tuple[int, Pose]]:
        """Times in ns and T_WC by the poses T_FB of messages."""

        def link(a: str, b: str) -> Pose:
            T_AB = frames.rigid(a, b)
            if T_AB is None:
                raise Refusal(f"{self.poses.topic.name}: no fixed transform of tf links the frames "
                              f"{a!r} and {b!r}; give other poses, or a bag with it")  # fmt: skip
            return T_AB

        T_BC, T_WF = identity(), identity()
        if self.poses.child is None:
            name = self.poses.topic.name
            self.bag.tell(f"{name} names no child frame: its poses are taken as the camera's")
        else:
            T_BC = link(self.poses.child, camera)
        if self.asked.world_frame:
            T_WF = link(frame_of(self.asked.world_frame), self.poses.frame)
        rows = zip(self.poses.times(by_stamp), self.poses.rows())
        return [(t, T_WF @ Pose(np.array(row[:4]), np.array(row[4:])) @ T_BC) for t, row in rows]


def print_topics(bag: Bag) -> None:
    rows = [("topic", "type", "messages", "seconds", "Hz")]
    for topic in bag.topics:
        seconds = bag.span_ns(topic) / SECOND_NS
        rate = f"{(topic.messages - 1) / seconds:.2f}" if seconds > 0 else "-"
        rows.append((one_line(topic.name), shown(topic.type), str(topic.messages), f"{seconds:.3f}", rate))
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        padded = [cell.ljust(n) for cell, n in zip(row[:2], widths)]
        padded += [cell.rjust(n) for cell, n in zip(row[2:], widths[2:])]
        print("  ".join(padded))
    print("\nA replay can take:")
    for kind in KINDS:
        print(f"  --{kind + '-topic':18} {names_of(found(bag, kind)) or '(none in this bag)'}")
    for line in bag.told:
        print(f"note: {line}")


class Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:
        self.exit(2, f"error: {self.prog}: {one_line(message)}; --help lists the options\n")


def arguments_of(words: list[str]) -> argparse.Namespace:
    parser = Parser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("bag", type=Path, help=".bag, .db3, .mcap or a folder of rosbag2")
    parser.add_argument("--out", type=Path, help="new folder for the recording; else prints the topics")
    for kind in KINDS:
        parser.add_argument(f"--{kind}-topic", metavar="T")
    parser.add_argument("--world-frame", metavar="F", help="frame of the poses; needed for those of tf")
    return parser.parse_args(words)


def main(words: list[str]) -> int:
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")
    asked = arguments_of(words)

    def refuse(why: str, code: int = 2) -> int:
        print(f"error: {one_line(asked.bag)}: {one_line(why)}", file=sys.stderr)
        return code

    if not HAS_ROSBAGS:
        return refuse("reading bags needs the Python package rosbags; install it with: "
                      f"{sys.executable} -m pip install rosbags", 3)  # fmt: skip
    np.seterr(all="ignore")  # checks of the results follow; a warning would be a second line
    try:
        with contextlib.ExitStack() as stack:
            bag = Bag(asked.bag, stack)
            if asked.out:
                recording = Recording(bag, asked)
                with whole_or_nothing(asked.out):
                    recording.write()
            else:
                print_topics(bag)
            sys.stdout.flush()
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except Refusal as refusal:
        return refuse(str(refusal))
    except OSError as fault:
        return refuse(f"{fault}; make room, or give another folder as --out")
    except Exception as fault:  # of a damaged file, in a place that no other rule names
        return refuse(f"reading fails ({type(fault).__name__}: {fault_of(fault)}); give another bag")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
