#!/usr/bin/env python3
"""A recording of ROS 1 or ROS 2 as a folder in EuRoC's ASL layout: read_bag.py BAG [--out DIR ...]

BAG is a .bag, .db3 or .mcap, or a folder of rosbag2. Without --out it prints the topics. Needs
PyPI's rosbags. T_AB is the pose of frame B in frame A: it takes B's coordinates to A's.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import math
import shutil
import sys
from bisect import bisect_left
from functools import partial
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, NamedTuple, NoReturn

DECOMPRESSORS = {"bz2": "BZ2Decompressor", "lz4.frame": "LZ4FrameDecompressor",
                 "compression.zstd": "ZstdDecompressor", "backports.zstd": "ZstdDecompressor"}  # fmt: skip
MOST_MIB = 256  # of a chunk or message: more than the largest picture that a replay takes


class Refusal(Exception):
    """A fault of the input, as "what; remedy"."""


def bounded(decompressor: Callable[[], Any]) -> Callable[..., bytes]:
    """A library's `decompress` that refuses a few bytes that grow without a bound."""

    def decompress(data: bytes, *_: Any) -> bytes:
        parts, left = [], MOST_MIB << 20
        while data:  # frame by frame
            one = decompressor()
            parts.append(one.decompress(data, left + 1))
            left -= len(parts[-1])
            if left < 0:
                raise Refusal(f"a chunk or message has more than {MOST_MIB} MiB once it is "
                              "decompressed; write the bag with smaller chunks")  # fmt: skip
            if not one.eof:
                raise ValueError("compressed data end too early")
            data = one.unused_data
        return b"".join(parts)

    return decompress


for name, kind in DECOMPRESSORS.items():  # before rosbags imports them
    with contextlib.suppress(ImportError):
        library = importlib.import_module(name)
        library.decompress = bounded(getattr(library, kind))

try:
    import numpy as np
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    HAS_ROSBAGS = True
except ImportError:
    HAS_ROSBAGS = False

SECOND_NS = 10**9
NEUTRAL = "turn it into the folder of tools/replay/NEUTRAL.md"
TF = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
KINDS = {
    "image": ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"),
    "imu": ("sensor_msgs/msg/Imu",),
    "camera-info": ("sensor_msgs/msg/CameraInfo",),
    "poses": ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped",
              "geometry_msgs/msg/TransformStamped", "nav_msgs/msg/Odometry", *TF),
    "odometry": ("nav_msgs/msg/Odometry",),
}  # fmt: skip
SENSORS = ("angular_velocity", "linear_acceleration")  # of an IMU
# Encoding: number of channels, indices of red, green and blue (or grey), bytes of a channel.
ENCODINGS = {
    "mono8": (1, [0], 1), "8UC1": (1, [0], 1), "mono16": (1, [0], 2), "16UC1": (1, [0], 2),
    "rgb8": (3, [0, 1, 2], 1), "bgr8": (3, [2, 1, 0], 1), "8UC3": (3, [2, 1, 0], 1),
    "rgba8": (4, [0, 1, 2], 1), "bgra8": (4, [2, 1, 0], 1),
    **{f"bayer_{pattern}8": (1, [0], 1) for pattern in ("rggb", "bggr", "gbrg", "grbg")},
}  # fmt: skip
MAGIC = {b"P5\n": "pgm", b"P6\n": "ppm", b"\xff\xd8\xff": "jpg", b"\x89PNG\r\n\x1a\n": "png"}
DISTORTIONS = dict.fromkeys(("plumb_bob", "rational_polynomial"), "radial-tangential")
DISTORTIONS |= dict.fromkeys(("equidistant", "fisheye"), "equidistant")
HEADERS = {
    "imu": "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
           "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]",
    "odometry": "#timestamp [ns],v_RB_B_x [m s^-1],v_RB_B_y [m s^-1],v_RB_B_z [m s^-1],"
                "w_RB_B_z [rad s^-1]",
}  # fmt: skip


class Topic(NamedTuple):
    name: str
    type: str
    messages: int


class Pose(NamedTuple):
    """T_AB: q is a unit quaternion w x y z, p a position in metres."""

    q: np.ndarray
    p: np.ndarray

    def turned(self, vectors: np.ndarray) -> np.ndarray:
        """A vector of B, or one in each row, in A's axes."""
        w, v = self.q[0], self.q[1:]
        return vectors + 2 * np.cross(v, w * vectors + np.cross(v, vectors))

    def __matmul__(self, other: Pose) -> Pose:
        w, v, other_w, other_v = self.q[0], self.q[1:], other.q[0], other.q[1:]
        vector = w * other_v + other_w * v + np.cross(v, other_v)
        return Pose(np.array([w * other_w - v @ other_v, *vector]), self.p + self.turned(other.p))

    def inverse(self) -> Pose:
        turn = Pose(self.q * [1, -1, -1, -1], self.p)
        return turn._replace(p=-turn.turned(self.p))


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


def frame_of(name: str) -> str:
    """Old releases of tf begin a name with a slash, new ones do not."""
    return name.lstrip("/")


def stamp_of(header: Any) -> int:
    """The header's time in ns."""
    return header.stamp.sec * SECOND_NS + header.stamp.nanosec


def require_ros2_profile(file: Path) -> None:
    """Refuses an MCAP of ROS 1, protobuf or JSON: its header has a profile, with its length."""
    head = file.open("rb").read(512) if file.suffix == ".mcap" and file.is_file() else b""
    if head.startswith(b"\x89MCAP0\r\n\x01") and len(head) > 21:
        profile = head[21 : 21 + int.from_bytes(head[17:21], "little")].decode(errors="replace")
        if profile != "ros2":
            raise Refusal(f"is a sound MCAP of the profile {profile!r}, and only ROS 2's (cdr) is read; "
                          "give the .bag that it was made from, or " + NEUTRAL)  # fmt: skip


def connections_of(reader: Any) -> list:
    """Of an MCAP whose summary does not repeat its channels by a scan of the whole file."""
    storage = getattr(reader, "storage", None)
    if not reader.connections and hasattr(storage, "meta_scan"):
        storage.meta_scan()
        counts = storage.statistics.channel_message_counts
        storage.connections = [c._replace(msgcount=counts.get(c.id, 0)) for c in storage.connections]
    return reader.connections


class Bag:
    """The messages of a bag. `told` has a line on each that is left out, and on all assumptions."""

    def __init__(self, path: Path) -> None:
        self.told: list[str] = []
        self._is_ros1 = path.suffix == ".bag"
        parts = [path]
        if path.is_dir() and not (path / "metadata.yaml").exists():
            files = [file for file in path.iterdir() if file.suffix in (".db3", ".mcap")]
            parts = sorted(files, key=lambda file: (len(file.name), file.name)) or [path]
        for part in parts:
            require_ros2_profile(part)
        self._readers = [(Reader1 if self._is_ros1 else Reader2)(part) for part in parts]
        for reader in self._readers:
            reader.open()
        self._connections = [c for reader in self._readers for c in connections_of(reader)]
        if not self._connections and path.suffix == ".mcap":
            raise Refusal("holds no channel, so that no message has a type; record it anew, or " + NEUTRAL)
        counts: dict[tuple[str, str], int] = {}
        for c in self._connections:
            counts[c.topic, c.msgtype] = counts.get((c.topic, c.msgtype), 0) + c.msgcount
        self.topics = [Topic(*key, count) for key, count in sorted(counts.items())]

    def tell(self, line: str) -> None:
        if one_line(line) not in self.told:
            self.told.append(one_line(line))

    def messages(self, topics: Iterable[Topic]) -> Iterator[tuple[Topic, int, bytes]]:
        """Topic, receive time in ns and bytes of each message; ends where the bag is damaged."""
        wanted = {topic[:2]: topic for topic in topics}
        for reader in self._readers:
            mine = [c for c in reader.connections if (c.topic, c.msgtype) in wanted]
            try:
                for c, t_ns, data in reader.messages(mine) if mine else ():  # of none it gives all
                    yield wanted[c.topic, c.msgtype], t_ns, data
            except Refusal:
                raise
            except Exception as fault:  # of any type: rosbags passes its libraries' exceptions on
                self.tell(f"the bag is read up to a fault, and no further: {fault_of(fault)}")

    def _parser(self, type_: str) -> Callable[[bytes, str], Any]:
        """Of the bag's definition of a type, or if there is none of ROS's."""
        store = get_typestore(Stores.ROS1_NOETIC if self._is_ros1 else Stores.ROS2_HUMBLE)
        for c in self._connections:
            if c.msgtype == type_ and c.msgdef.format.name == "MSG":
                with contextlib.suppress(Exception):  # the definition is damaged
                    own = get_typestore(Stores.EMPTY)
                    own.register(get_types_from_msg(c.msgdef.data, type_))
                    own.get_msgdef(type_)
                    store = own
        return store.deserialize_ros1 if self._is_ros1 else store.deserialize_cdr

    def read(self, readers: list[tuple[Topic, Callable[[Any, int], None]]]) -> None:
        """Passes each message and its receive time to its readers, and tells the damaged ones."""
        parsers = {topic: self._parser(topic.type) for topic, _ in readers}
        left_out: dict[Topic, list[str]] = {topic: [] for topic in parsers}
        for topic, t_ns, data in self.messages(parsers):
            try:
                message = parsers[topic](data, topic.type)
                for wanted, read in readers:
                    if wanted == topic:
                        read(message, t_ns)
            except (Refusal, OSError):
                raise
            except Exception as fault:
                left_out[topic].append(f"first at {t_ns} ns: {fault_of(fault)}")
        for topic, faults in left_out.items():
            if faults:
                self.tell(f"{len(faults)} messages of {topic.name} are unreadable and left out, "
                          f"{faults[0]}")  # fmt: skip


class Frames:
    """T_AB by the frames (A, B) of tf: the pose at each time if `keeps_all`, else the first."""

    def __init__(self, bag: Bag, by_stamp: bool, keeps_all: bool) -> None:
        self._by_stamp, self._keeps_all = by_stamp, keeps_all
        self._poses: dict[tuple, dict[int, Pose]] = {}
        self._static: set[tuple] = set()
        self._moving: set[tuple] = set()
        topics = [topic for topic in bag.topics if topic.type in TF]
        bag.read([(t, partial(self._read, t.name.endswith("tf_static"))) for t in topics])
        self._moving -= self._static
        self._first = {edge: next(iter(poses.values())) for edge, poses in self._poses.items()}
        self._times = {edge: sorted(poses) for edge, poses in self._poses.items()}

    def _read(self, is_static: bool, message: Any, t_ns: int) -> None:
        for one in message.transforms:
            with contextlib.suppress(ValueError):
                T_AB = pose_of(one.transform.translation, one.transform.rotation)
                edge = (frame_of(one.header.frame_id), frame_of(one.child_frame_id))
                if is_static:
                    self._static.add(edge)
                    self._poses[edge] = {}  # of several the last holds
                poses = self._poses.setdefault(edge, {})
                first = next(iter(poses.values()), T_AB)
                if max(abs(first.p - T_AB.p)) > 1e-6 or abs(first.q @ T_AB.q) < 1 - 1e-12:
                    self._moving.add(edge)
                if self._keeps_all or not poses:
                    poses.setdefault(stamp_of(one.header) if self._by_stamp else t_ns, T_AB)

    def _path(self, a: str, b: str, edges: Iterable[tuple]) -> list[tuple[tuple, bool]] | None:
        """The edges from frame a to b, each with whether it leads from parent to child."""
        paths: dict[str, list] = {frame_of(a): []}
        queue = [frame_of(a)]
        for frame in queue:  # grows in the loop
            for parent, child in edges:
                for here, there in ((parent, child), (child, parent)):
                    if here == frame and there not in paths:
                        paths[there] = [*paths[frame], ((parent, child), here == parent)]
                        queue.append(there)
        return paths.get(frame_of(b))

    def rigid(self, a: str, b: str) -> Pose | None:
        """T_AB, absent unless transforms that never change link the two."""
        path = self._path(a, b, self._poses.keys() - self._moving)
        return None if path is None else along(path, self._first.__getitem__)

    def poses(self, world: str | None, camera: str) -> Iterator[tuple[int, Pose]]:
        """Times in ns and T_WC, at the times of the fastest moving transform between the two."""
        if world is None:
            roots = sorted({a for a, _ in self._poses} - {b for _, b in self._poses})
            raise Refusal(f"tf has many frames; give --world-frame, perhaps {' or '.join(roots)}")
        path = self._path(world, camera, self._poses) or []
        timed = [edge for edge, _ in path if edge not in self._static]
        if not timed:
            raise Refusal(f"no moving transform of tf links the frames {world!r} and {camera!r} "
                          "(camera); give another --world-frame")  # fmt: skip
        pace = max(timed, key=lambda edge: (edge in self._moving, len(self._times[edge])))
        for t_ns in self._times[pace]:
            with contextlib.suppress(LookupError):
                yield t_ns, along(path, partial(self._pose_at, t_ns))

    def _pose_at(self, t_ns: int, edge: tuple) -> Pose:
        """T_AB at a time. Raises LookupError outside the times."""
        poses, times = self._poses[edge], self._times[edge]
        if edge not in self._moving or t_ns in poses:
            return poses.get(t_ns, self._first[edge])
        after = bisect_left(times, t_ns)
        if after in (0, len(times)):
            raise LookupError
        one, two = poses[times[after - 1]], poses[times[after]]
        b = (t_ns - times[after - 1]) / (times[after] - times[after - 1])
        a, cosine = 1 - b, one.q @ two.q
        turns = math.acos(min(abs(cosine), 1.0)) / math.pi
        q = a * np.sinc(a * turns) * one.q + math.copysign(b, cosine) * np.sinc(b * turns) * two.q
        return Pose(q / np.linalg.norm(q), a * one.p + b * two.p)


def along(path: list[tuple[tuple, bool]], T_of: Callable[[tuple], Pose]) -> Pose:
    T = identity()
    for edge, is_forward in path:
        T = T @ (T_of(edge) if is_forward else T_of(edge).inverse())
    return T


class Series:
    """The rows of a topic's messages with both times of each in ns, and the frames they name."""

    def __init__(self, topic: Topic, row_of: Callable[[Any], Any]) -> None:
        self.topic, self._row_of = topic, row_of
        self.stamps: list[int] = []
        self.received: list[int] = []
        self.times = self.stamps
        self.rows: list[Any] = []
        self.frame = ""
        self.child: str | None = None  # absent from messages of a type without it

    def read(self, message: Any, t_ns: int) -> None:
        frames = message.header.frame_id, getattr(message, "child_frame_id", None)
        if self.rows and frames != (self.frame, self.child):
            raise ValueError("it is of another frame than the first message")
        self.rows.append(self._row_of(message))
        self.stamps.append(stamp_of(message.header))
        self.received.append(t_ns)
        self.frame, self.child = frames


def imu_row(message: Any) -> tuple:
    """Angular rate in rad/s and acceleration in m/s^2, in the IMU's frame; 0 for one that it lacks."""
    rows = []
    for name in SENSORS:
        vector, covariance = getattr(message, name), getattr(message, f"{name}_covariance")
        rows += [0.0] * 3 if covariance[0] == -1 else [vector.x, vector.y, vector.z]
    return tuple(rows)


def sensors_of(imu: Series) -> tuple[bool, bool]:
    """Whether some reading has an angular rate, and an acceleration."""
    return tuple(np.array(imu.rows).reshape(-1, 2, 3).any(axis=(0, 2)))


def odometry_row(message: Any) -> tuple:
    """Velocity in m/s and yaw rate in rad/s, in the child frame."""
    twist = message.twist.twist
    return twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z


def pose_row(message: Any) -> Pose:
    """The pose of the child in the header's frame."""
    if hasattr(message, "transform"):
        return pose_of(message.transform.translation, message.transform.rotation)
    pose = getattr(message.pose, "pose", message.pose)
    return pose_of(pose.position, pose.orientation)


def netpbm(message: Any) -> bytes:
    """A PGM or PPM of a sensor_msgs/Image whose encoding is known."""
    channels, order, size = ENCODINGS[message.encoding]
    width, height, step = message.width, message.height, message.step
    if not (width and height and step * height <= len(message.data)):
        raise ValueError(f"{len(message.data)} bytes are too few for {width}x{height} pixels")
    rows = np.frombuffer(message.data, np.uint8)[: step * height].reshape(height, step)
    pixels = np.ascontiguousarray(rows[:, : width * channels * size])
    pixels = pixels.view(f"{'>' if message.is_bigendian else '<'}u{size}")
    pixels = pixels.reshape(height, width, channels)[:, :, order].astype(f">u{size}")
    magic = "P6" if len(order) == 3 else "P5"
    return f"{magic}\n{width} {height}\n{256**size - 1}\n".encode() + pixels.tobytes()


def has_clock(stamps: list[int]) -> bool:
    """Whether nearly all stamps in ns increase, and none falls back by more than ten periods."""
    steps = np.diff(stamps)
    if not len(steps):
        return any(stamps)
    return np.mean(steps <= 0) < 0.1 and min(steps) > -10 * np.median(steps)


def write_picture(folder: Path, written: Series, message: Any) -> tuple[Path, str]:
    """Its file, whose name is a number until the clock is known, and its encoding."""
    is_raw = written.topic.type.endswith("/Image")
    encoding = message.encoding if is_raw else ""
    data = b"" if is_raw else message.data.tobytes()
    if encoding in ENCODINGS:
        data = netpbm(message)
    kind = next((MAGIC[magic] for magic in MAGIC if data.startswith(magic)), "")
    if not kind:
        refusal = ValueError if written.rows else Refusal  # an odd one among others is left out
        raise refusal(f"pictures of the format {encoding or message.format!r} cannot be read; "
                      f"give JPEG, PNG or one of {', '.join(ENCODINGS)}")  # fmt: skip
    file = folder / f"part{len(written.rows)}.{kind}"
    file.write_bytes(data)
    return file, encoding


def lens_yaml(is_rectified: bool, bag: Bag, info: Any) -> tuple[str, ...]:
    """Lines of a sensor.yaml by a CameraInfo; none for a camera that is not calibrated."""
    names = [name if hasattr(info, name) else name.lower() for name in "KPD"]  # of ROS 1 or 2
    K, P, D = (getattr(info, name).tolist() for name in names)
    intrinsics = [P[0], P[5], P[2], P[6]] if is_rectified else [K[0], K[4], K[2], K[5]]
    model = DISTORTIONS.get(info.distortion_model.lower()) if D else None
    if is_rectified or (model is None and not any(D)):
        model = "none"
    if not (model and all(map(math.isfinite, intrinsics + D)) and min(intrinsics[:2]) > 0):
        bag.tell(f"the camera is not calibrated: its focal lengths are {intrinsics[:2]} pixels, "
                 f"its distortion is {info.distortion_model!r}")  # fmt: skip
        return ()
    distortion = [] if model == "none" else [f"distortion_coefficients: {D}"]
    return (f"resolution: [{info.width}, {info.height}]", "camera_model: pinhole",
            f"intrinsics: {intrinsics}", f"distortion_model: {model}", *distortion)  # fmt: skip


def found(bag: Bag, kind: str) -> list[Topic]:
    return [topic for topic in bag.topics if topic.type in KINDS[kind] and topic.messages]


def names_of(topics: list[Topic]) -> str:
    return one_line("  ".join(topic.name for topic in topics)) or "(none in this bag)"


def chosen(bag: Bag, kind: str, name: str | None, others: list[Topic]) -> Topic | None:
    """The topic of that name, or if there is none the only one of the others."""
    topics = others
    if name is not None:
        every = found(bag, kind)
        topics = [topic for topic in every if frame_of(topic.name) == frame_of(name)]
        if not topics:
            types = ", ".join(KINDS[kind]).replace("/msg/", "/")
            raise Refusal(f"has no messages {name} of {types}; give one of {names_of(every)}")
    if len(topics) > 1:
        raise Refusal(f"has several topics; give --{kind}-topic, one of {names_of(topics)}")
    if topics and name is None:
        bag.tell(f"--{kind}-topic is {topics[0].name}, the only one that fits")
    return topics[0] if topics else None


def write_lines(file: Path, lines: Iterable[str]) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w") as out:
        out.writelines(f"{line}\n" for line in lines)


def sensor_yaml(kind: str, T_BS: Pose | None, times: list[int]) -> list[str]:
    lines = [f"sensor_type: {kind}"]
    if T_BS is not None:
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = T_BS.turned(np.eye(3)).T, T_BS.p
        lines += ["T_BS:", "  cols: 4", "  rows: 4", f"  data: {matrix.ravel().tolist()}"]
    periods = np.diff(times)
    if any(periods > 0):
        lines.append(f"rate_hz: {round(SECOND_NS / float(np.median(periods[periods > 0])), 6)}")
    return lines


class Recording:
    """The topics of a bag that make a recording, and the folder of it."""

    def __init__(self, bag: Bag, asked: argparse.Namespace) -> None:
        self.bag, self.out, self.world = bag, asked.out, asked.world_frame
        image = chosen(bag, "image", asked.image_topic, found(bag, "image"))
        if image is None:
            raise Refusal("has no topic of sensor_msgs/Image or CompressedImage; give one that has")
        names = (image.name, image.name.removesuffix("/compressed"))
        places = [f"{name.rpartition('/')[0]}/camera_info" for name in names]  # ROS's convention
        infos = [topic for topic in found(bag, "camera-info") if topic.name in places]
        info = chosen(bag, "camera-info", asked.camera_info_topic, infos)
        imus, no_tf = found(bag, "imu"), [t for t in found(bag, "poses") if t.type not in TF]
        if asked.own_motion:
            if imus and not asked.imu_topic:
                bag.tell(f"the motion is yours, and the bag's IMU {names_of(imus)} is not read")
            imus, no_tf = [], []
        imu = chosen(bag, "imu", asked.imu_topic, [] if asked.poses_topic else imus)
        poses = chosen(bag, "poses", asked.poses_topic, [] if imu else no_tf)
        odometry = chosen(bag, "odometry", asked.odometry_topic, [])
        self.camera = self.out / "mav0" / "cam0"
        self.pictures = Series(image, lambda message: write_picture(
            self.camera / "data", self.pictures, message))  # fmt: skip
        is_rectified = "image_rect" in image.name
        self.lens = Series(info, partial(lens_yaml, is_rectified, bag)) if info else None
        self.imu = Series(imu, imu_row) if imu else None
        self.odometry = Series(odometry, odometry_row) if odometry else None
        self.poses = Series(poses, pose_row) if poses and poses.type not in TF else None
        self.has_tf_poses = bool(poses and not self.poses)
        self.sensors: tuple[Series, Series] | None = None  # in two topics: gyroscope, accelerometer

    def write(self) -> None:
        (self.camera / "data").mkdir(parents=True)
        every = [one for one in (self.pictures, self.imu, self.odometry, self.poses) if one]
        self._read(every)
        if self.lens and not self.pictures.frame:
            self.pictures.frame = self.lens.frame
        frames = Frames(self.bag, self._takes_stamps(every), keeps_all=self.has_tf_poses)
        if self.sensors:
            self._join_sensors(frames)
        self._write_camera(frames)
        self._write_rows("imu", self.imu, identity())
        if self.odometry:
            T_SB = self._T_SX(frames, self.odometry.child or "", "odometry")
            self._write_rows("odometry", self.odometry, T_SB)
        if self.poses:
            self._write_poses(self._camera_poses(self.poses, frames))
        if self.has_tf_poses:
            self._write_poses(frames.poses(self.world, self.pictures.frame))
        encoding = self.pictures.rows[0][1]
        bayer = {"bayer": encoding[6:10]} if encoding.startswith("bayer_") else {}
        write_lines(self.out / "bag.json", [json.dumps({"told": self.bag.told, **bayer}, indent=2)])

    def _read(self, every: list[Series]) -> None:
        told = len(self.bag.told)
        self.bag.read([(one.topic, one.read) for one in (*every, self.lens) if one])
        why = ", ".join(self.bag.told[told:]) or "there is none"
        for series in every:
            if not series.rows:
                raise Refusal(f"no message of {series.topic.name} can be read ({why}); "
                              "give another topic")  # fmt: skip
        if self.imu and (other := self._other_sensor()):
            every.append(other)

    def _other_sensor(self) -> Series | None:
        """The only other topic of an IMU that has the sensor which this one lacks, and no more."""
        has = sensors_of(self.imu)
        if all(has):
            return None
        others = [topic for topic in found(self.bag, "imu") if topic != self.imu.topic]
        series = [Series(topic, imu_row) for topic in others]
        self.bag.read([(one.topic, one.read) for one in series])
        fit = [one for one in series if one.rows and sensors_of(one) == (not has[0], not has[1])]
        if len(fit) != 1 or not any(has):
            raise Refusal(f"{self.imu.topic.name} has no {SENSORS[has.index(False)].replace('_', ' ')}, and "
                          f"not just one other topic has it alone ({names_of(others)}); record both in one "
                          "topic (realsense: unite_imu_method:=2), or " + NEUTRAL)  # fmt: skip
        self.sensors = (self.imu, fit[0]) if has[0] else (fit[0], self.imu)
        return fit[0]

    def _join_sensors(self, frames: Frames) -> None:
        """Takes the accelerometer's readings, linear between two, at the times of the gyroscope."""
        gyro, accel = self.sensors
        T_GA = identity() if gyro.frame == accel.frame else frames.rigid(gyro.frame, accel.frame)
        if T_GA is None:
            raise Refusal(f"no fixed transform of tf links the frames {gyro.frame!r} of {gyro.topic.name} and "
                          f"{accel.frame!r} of {accel.topic.name}; " + NEUTRAL)  # fmt: skip
        times, first = np.unique(accel.times, return_index=True)
        forces = T_GA.turned(np.array(accel.rows)[first, 3:])
        kept = [i for i, t in enumerate(gyro.times) if times[0] <= t <= times[-1]]
        if not kept:
            raise Refusal(f"{gyro.topic.name} and {accel.topic.name} have no common time; " + NEUTRAL)
        at = np.array(gyro.times)[kept] - times[0]
        joined = [np.interp(at, times - times[0], force) for force in forces.T]
        self.imu = gyro
        gyro.rows = [(*gyro.rows[i][:3], *map(float, force)) for i, force in zip(kept, zip(*joined))]
        gyro.times = [gyro.times[i] for i in kept]
        self.bag.tell(f"the accelerations of {accel.topic.name} are interpolated to the times of {gyro.topic.name}")

    def _takes_stamps(self, every: list[Series]) -> bool:
        """Takes all times from the headers, or if some are of no use from the receiver's clock.

        Single stamps that repeat or are late do not matter: later readers sort them.
        """
        bad = [series.topic for series in every if not has_clock(series.stamps)]
        if bad:
            self.bag.tell(f"the header stamps of {names_of(bad)} are all 0, mostly repeat or fall "
                          "back: all times are receive times")  # fmt: skip
            for series in every:
                series.times = series.received
        return not bad

    def _T_SX(self, frames: Frames, other: str, what: str) -> Pose | None:
        """The pose of a sensor's frame X in the IMU's frame S."""
        T_SX = frames.rigid(self.imu.frame, other) if self.imu and other else None
        if self.imu and T_SX is None:
            self.bag.tell(f"no fixed transform of tf links the frames {self.imu.frame!r} (IMU) and "
                          f"{other!r} ({what}): it has no T_BS")  # fmt: skip
        return T_SX

    def _write_camera(self, frames: Frames) -> None:
        if "optical" not in self.pictures.frame:
            self.bag.tell(f"{self.pictures.frame!r} is taken as an optical frame: z looks ahead")
        names = {}
        for t_ns, (file, _) in zip(self.pictures.times, self.pictures.rows):
            if t_ns not in names:
                names[t_ns] = file.rename(file.with_stem(str(t_ns))).name
        if doubles := len(self.pictures.rows) - len(names):
            self.bag.tell(f"{doubles} pictures have the time of another one and are left out")
        rows = (f"{t_ns},{name}" for t_ns, name in names.items())
        write_lines(self.camera / "data.csv", ["#timestamp [ns],filename", *rows])
        T_SC = self._T_SX(frames, self.pictures.frame, "camera")
        lenses = self.lens.rows if self.lens else []
        if len(set(lenses)) > 1:
            self.bag.tell("the calibration changes; its first is used")
        if lenses or T_SC:
            lines = [*sensor_yaml("camera", T_SC, self.pictures.times), *(lenses or [()])[0]]
            write_lines(self.camera / "sensor.yaml", lines)

    def _write_rows(self, kind: str, series: Series | None, T_BS: Pose | None) -> None:
        if series:
            folder = self.out / "mav0" / f"{kind}0"
            rows = (f"{t},{','.join(map(repr, row))}" for t, row in zip(series.times, series.rows))
            write_lines(folder / "data.csv", (HEADERS[kind], *rows))
            write_lines(folder / "sensor.yaml", sensor_yaml(kind, T_BS, series.times))

    def _camera_poses(self, poses: Series, frames: Frames) -> list[tuple[int, Pose]]:
        """Times in ns and T_WC by the poses T_FB of messages."""
        name, camera = poses.topic.name, self.pictures.frame
        if poses.child is None:
            self.bag.tell(f"{name} names no child frame: its poses are taken as the camera's")
        body = camera if poses.child is None else poses.child
        T_WF = frames.rigid(self.world or poses.frame, poses.frame)
        T_BC = frames.rigid(body, camera)
        if T_WF is None or T_BC is None:
            a, b = (body, camera) if T_BC is None else (self.world, poses.frame)
            raise Refusal(f"{name}: no fixed transform of tf links the frames {a!r} and {b!r}; "
                          "give other poses, or a bag with it")  # fmt: skip
        return [(t_ns, T_WF @ T_FB @ T_BC) for t_ns, T_FB in zip(poses.times, poses.rows)]

    def _write_poses(self, poses: Iterable[tuple[int, Pose]]) -> None:
        lines = []
        for t_ns, (q, p) in poses:
            numbers = " ".join(map(repr, [*p.tolist(), *q[1:].tolist(), float(q[0])]))
            lines.append(f"{t_ns // SECOND_NS}.{t_ns % SECOND_NS:09d} {numbers}")
        write_lines(self.out / "poses.txt", lines)


def print_topics(bag: Bag) -> None:
    times: dict[Topic, list[int]] = {}
    for topic, t_ns, _ in bag.messages(bag.topics):
        times.setdefault(topic, [t_ns, t_ns])[1] = t_ns
    rows = [("topic", "type", "messages", "  seconds", "      Hz")]
    for topic in bag.topics:
        first, last = times.get(topic, (0, 0))
        seconds = (last - first) / SECOND_NS
        rate = f"{(topic.messages - 1) / seconds:8.2f}" if seconds > 0 else f"{'-':>8}"
        name, type_ = one_line(topic.name), one_line(topic.type).replace("/msg/", "/")
        rows.append((name, type_, f"{topic.messages:8}", f"{seconds:9.3f}", rate))
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        print("  ".join(map(str.ljust, row, widths)))
    print("\nA replay can take:")
    for kind in KINDS:
        print(f"  --{kind + '-topic':18} {names_of(found(bag, kind))}")
    for line in bag.told:
        print(f"note: {line}")


class Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"error: {self.prog}: {one_line(message)}; --help lists the options\n")


def arguments_of(words: list[str]) -> argparse.Namespace:
    parser = Parser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("bag", type=Path, help=".bag, .db3, .mcap or a folder of rosbag2")
    parser.add_argument("--out", type=Path, help="new folder of the recording; else prints topics")
    for kind in KINDS:
        parser.add_argument(f"--{kind}-topic", metavar="T")
    parser.add_argument("--own-motion", action="store_true", help="choose no IMU and no poses")
    parser.add_argument("--world-frame", metavar="F", help="frame of the poses; tf's need it")
    return parser.parse_args(words)


def run(asked: argparse.Namespace) -> None:
    if not HAS_ROSBAGS:
        raise Refusal("reading bags needs the Python package rosbags; install it with: "
                      f"{sys.executable} -m pip install rosbags")  # fmt: skip
    np.seterr(all="ignore")  # checks of the results follow; a warning would be a second line
    bag = Bag(asked.bag)
    if not asked.out:
        return print_topics(bag)
    recording = Recording(bag, asked)
    asked.out.mkdir(parents=True)
    try:
        recording.write()
    except BaseException:
        shutil.rmtree(asked.out, ignore_errors=True)
        raise


def main(words: list[str]) -> int:
    asked = arguments_of(words)
    try:
        run(asked)
        return 0
    except KeyboardInterrupt:
        return 130
    except Refusal as refusal:
        why = str(refusal)
    except OSError as fault:
        why = f"{fault}; give a bag that can be read, and a new folder with room as --out"
    except Exception as fault:  # of any type: rosbags passes its libraries' exceptions on
        why = (f"cannot be read ({type(fault).__name__}: {fault_of(fault)}); give a whole .bag, "
               ".db3, .mcap or folder of rosbag2 ('rosbag reindex', 'mcap recover' and "
               "'ros2 bag reindex' repair them)")  # fmt: skip
    print(f"error: {one_line(asked.bag)}: {one_line(why)}", file=sys.stderr)
    return 2 if HAS_ROSBAGS else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
