#!/usr/bin/env python3
"""replay_test.py LCS WORK: a generated sequence, written as a bag of MCAP by rosbags, is replayed as
its folder of EuRoC's layout is."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from replays import replay

LCS, WORK = sys.argv[1], Path(sys.argv[2])
SCENARIO = """
scene: lab
frames: 35
ego: {start: [-3, 0], speed: 0, phases: [{at: 1.3 s, acceleration: 0.4 m/s^2}]}
camera: {size: [320, 240]}
actors:
  crate:
    shape: box
    trajectory: {line: {from: [0, -1], heading: 90 deg, speed: 0.5}}
"""
STORE = get_typestore(Stores.ROS2_HUMBLE)
TYPES = STORE.types


def pixels(png: Path) -> np.ndarray:
    """BGR, by the program's own reader of pictures in Debian's Python."""
    code = "import cv2, sys; sys.stdout.buffer.write(cv2.imread(sys.argv[1]).tobytes())"
    data = subprocess.run(["/usr/bin/python3", "-c", code, png], check=True, capture_output=True).stdout
    return np.frombuffer(data, np.uint8)


def header(t_ns: int, frame: str) -> object:
    stamp = TYPES["builtin_interfaces/msg/Time"](t_ns // 10**9, t_ns % 10**9)
    return TYPES["std_msgs/msg/Header"](stamp, frame)


def vector(x: float, y: float, z: float) -> object:
    return TYPES["geometry_msgs/msg/Vector3"](x, y, z)


def write_bag(mav: Path, bag: Path) -> None:
    quaternion = TYPES["geometry_msgs/msg/Quaternion"]
    images = [line.split(",") for line in (mav / "cam0/data.csv").read_text().splitlines()[1:]]
    readings = [line.split(",") for line in (mav / "imu0/data.csv").read_text().splitlines()[1:]]
    calibration = (mav / "cam0/sensor.yaml").read_text()
    f, _, cx, cy = json.loads(calibration.split("intrinsics: ")[1].split("  #")[0])
    p = np.array(json.loads(calibration.split("data: ")[1].split("\n")[0])).reshape(4, 4)[:3, 3]
    with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        kinds = {"/camera/image_raw": "sensor_msgs/msg/Image", "/imu": "sensor_msgs/msg/Imu",
                 "/camera/camera_info": "sensor_msgs/msg/CameraInfo",
                 "/tf_static": "tf2_msgs/msg/TFMessage"}  # fmt: skip
        topics = {name: writer.add_connection(name, kind, typestore=STORE) for name, kind in kinds.items()}

        def send(name: str, t_ns: int, message: object) -> None:
            writer.write(topics[name], t_ns, STORE.serialize_cdr(message, kinds[name]))

        start = int(readings[0][0])
        # the camera looks ahead: its z is the IMU's x, its x is -y
        T = TYPES["geometry_msgs/msg/Transform"](vector(*p), quaternion(-0.5, 0.5, -0.5, 0.5))
        link = TYPES["geometry_msgs/msg/TransformStamped"](header(start, "imu"), "camera_optical", T)
        send("/tf_static", start, TYPES["tf2_msgs/msg/TFMessage"]([link]))
        for t, *numbers in readings:
            w, a, none = map(float, numbers[:3]), map(float, numbers[3:6]), np.zeros(9)
            send("/imu", int(t), TYPES["sensor_msgs/msg/Imu"](
                header(int(t), "imu"), quaternion(0, 0, 0, 1), none, vector(*w), none, vector(*a), none))
        for t, name in images:
            at = header(int(t), "camera_optical")
            send("/camera/image_raw", int(t), TYPES["sensor_msgs/msg/Image"](
                at, 240, 320, "bgr8", 0, 960, pixels(mav / "cam0/data" / name)))
            K, P = np.array([f, 0, cx, 0, f, cy, 0, 0, 1]), np.array([f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0])
            region = TYPES["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
            send("/camera/camera_info", int(t), TYPES["sensor_msgs/msg/CameraInfo"](
                at, 240, 320, "plumb_bob", np.zeros(5), K, np.eye(3).ravel(), P, 0, 0, region))


def main() -> None:
    (WORK / "drive.yaml").write_text(SCENARIO)
    sequence, bag = WORK / "drive", WORK / "bag"
    for folder in (sequence, bag):
        shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([LCS, "generate", WORK / "drive.yaml", "--formats", "euroc", "--quiet", "--out",
                    sequence], check=True)  # fmt: skip
    # Neither has the truth, from which EuRoC's recordings begin.
    (sequence / "lcs.json").unlink()
    shutil.rmtree(sequence / "mav0/state_groundtruth_estimate0")
    shutil.rmtree(sequence / "mav0/odometry0", ignore_errors=True)
    write_bag(sequence / "mav0", bag)
    folder = replay(LCS, sequence, WORK / "out-folder")
    file = replay(LCS, bag, WORK / "out-bag", "--image-topic", "/camera/image_raw", "--imu-topic", "/imu",
                  "--imu-calibration", str(sequence / "mav0/imu0/sensor.yaml"))
    assert len(folder) > 20 and folder == file, [k for k, pair in enumerate(zip(folder, file)) if pair[0] != pair[1]]
    assert sum(corners for corners, _ in folder) > 1000, folder


main()
