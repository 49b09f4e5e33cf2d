#!/usr/bin/env python3
"""mcap_test.py LCS WORK: `lcs generate --formats mcap` of a stereo rig, read by rosbags and by the mcap
package: stamps, pictures, intrinsics, poses and boxes are those of the sequence's other formats. Its
replay has the verdicts of the replay of the same sequence in EuRoC's layout."""

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import yaml
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from replays import replay

LCS, WORK = sys.argv[1], Path(sys.argv[2])
FRAMES = 35
SCENARIO = f"""
scene: lab
frames: {FRAMES}
ego: {{start: [-3, 0], speed: 0, phases: [{{at: 1.3 s, acceleration: 0.4 m/s^2}}]}}
odometry: {{rate: 20 Hz}}
cameras:
  left: {{size: [320, 240], position: [0.2, 0.06, 0.45]}}
  right: {{size: [320, 240], position: [0.2, -0.06, 0.45]}}
actors:
  crate:
    shape: box
    trajectory: {{line: {{from: [0, -1], heading: 90 deg, speed: 0.5}}}}
"""


def matrix(translation, q) -> np.ndarray:
    x, y, z, w = q.x, q.y, q.z, q.w
    T = np.eye(4)
    T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]  # fmt: skip
    T[:3, 3] = translation.x, translation.y, translation.z
    return T


def stamp(header) -> int:
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def read(bag: Path) -> dict:
    found: dict = {}
    with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        last = 0
        for c, t_ns, data in reader.messages():
            message = reader.deserialize(data, c.msgtype)
            header = message.transforms[0].header if hasattr(message, "transforms") else message.header
            assert stamp(header) == t_ns >= last, (c.topic, t_ns)
            last = t_ns
            found.setdefault(c.topic, []).append((t_ns, message))
    return found


def rows(file: Path) -> np.ndarray:
    lines = [line for line in csv.reader(file.open()) if not line[0].startswith("#")]
    return [(int(line[0]), [float(x) for x in line[1:]]) for line in lines]


def check_readings(found: dict, mav: Path) -> None:
    imu = [(t, [*vars(m.angular_velocity).values()][:3] + [*vars(m.linear_acceleration).values()][:3])
           for t, m in found["/imu0"]]  # fmt: skip
    assert imu == rows(mav / "imu0/data.csv") and len(imu) > 100
    assert all(m.orientation_covariance[0] == -1 for _, m in found["/imu0"])
    wheels = [(t, [m.twist.twist.linear.x, m.twist.twist.linear.y, m.twist.twist.linear.z,
                   m.twist.twist.angular.z]) for t, m in found["/odometry0"]]  # fmt: skip
    assert wheels == rows(mav / "odometry0/data.csv") and len(wheels) > 50


def check_poses(found: dict, sequence: Path) -> None:
    mav = sequence / "mav0"
    truth = rows(mav / "state_groundtruth_estimate0/data.csv")
    poses = {t: m.transforms[0] for t, m in found["/tf"]}
    assert list(poses) == [t for t, _ in truth]
    for t, (px, py, pz, w, x, y, z, *_) in truth:
        T = poses[t].transform
        assert (poses[t].header.frame_id, poses[t].child_frame_id) == ("world", "imu")
        assert (T.translation.x, T.translation.y, T.translation.z) == (px, py, pz)
        assert (T.rotation.w, T.rotation.x, T.rotation.y, T.rotation.z) == (w, x, y, z)
    links = {one.child_frame_id: matrix(one.transform.translation, one.transform.rotation)
             for one in found["/tf_static"][0][1].transforms}  # fmt: skip
    for i in (0, 1):
        sensor = yaml.safe_load((mav / f"cam{i}/sensor.yaml").read_text())
        assert np.allclose(links[f"cam{i}_optical"], np.reshape(sensor["T_BS"]["data"], (4, 4)), atol=1e-12)
    tum = np.loadtxt(sequence / "tum/camera.txt")
    for (t, message), row, (t_csv, T_csv) in zip(found["/truth/odometry"], tum, rows(mav / "cam0/pose.csv")):
        pose = message.pose.pose
        q = pose.orientation
        assert t == t_csv and abs(t * 1e-9 - row[0]) < 1e-6 and message.child_frame_id == "cam0_optical"
        assert np.allclose([pose.position.x, pose.position.y, pose.position.z, q.x, q.y, q.z, q.w], row[1:],
                           rtol=0, atol=1e-12)  # fmt: skip
        assert np.allclose(matrix(pose.position, q)[:3].ravel(), T_csv, atol=1e-12)
        if t in poses:  # the chain of tf
            T_WS = matrix(poses[t].transform.translation, poses[t].transform.rotation)
            assert np.allclose(T_WS @ links["cam0_optical"], matrix(pose.position, q), atol=1e-9)
    v = found["/truth/odometry"][-1][1].twist.twist.linear
    assert v.z > 0.5 and abs(v.x) + abs(v.y) < 0.01, f"it drives along the optical axis: {v}"


def check_views(found: dict, sequence: Path) -> None:
    base_px = []
    for i in (0, 1):
        mav = sequence / f"mav0/cam{i}"
        names = [line.split(",") for line in (mav / "data.csv").read_text().splitlines()[1:]]
        pictures = found[f"/cam{i}/image_raw/compressed"]
        assert [t for t, _ in pictures] == [int(t) for t, _ in names] and len(names) == FRAMES
        for (_, message), (_, name) in zip(pictures, names):
            assert message.data.tobytes() == (mav / "data" / name).read_bytes()
        sensor = yaml.safe_load((mav / "sensor.yaml").read_text())
        f, fv, cx, cy = sensor["intrinsics"]
        for t, info in found[f"/cam{i}/camera_info"]:
            assert info.k.tolist() == [f, 0, cx, 0, fv, cy, 0, 0, 1] and [info.width, info.height] == [320, 240]
            assert info.header.frame_id == f"cam{i}_optical" and not any(info.d)
        P = np.reshape(found[f"/cam{i}/camera_info"][0][1].p, (3, 4))
        kitti = (sequence / "kitti/calib.txt").read_text().splitlines()[i].split()
        assert kitti[0] == f"P{i}:" and P.ravel().tolist() == [float(x) for x in kitti[1:]]
        base_px.append(P[0, 3] / f)
        coco = json.loads((sequence / ("" if i == 0 else "cam1") / "coco/annotations.json").read_text())
        kinds = {one["id"]: one["name"] for one in coco["categories"]}
        expected = {(a["image_id"] - 1, str(a["track_id"])): (a["bbox"], kinds[a["category_id"]])
                    for a in coco["annotations"]}  # fmt: skip
        seen = {}
        for k, (_, message) in enumerate(found[f"/cam{i}/detections"]):
            for one in message.detections:
                centre, w, h = one.bbox.center.position, one.bbox.size_x, one.bbox.size_y
                box = [centre.x + 0.5 - w / 2, centre.y + 0.5 - h / 2, w, h]
                seen[k, one.id] = (box, one.results[0].hypothesis.class_id)
        assert seen == expected and any(kind == "box" for _, kind in seen.values())
    assert base_px[0] == 0 and abs(base_px[1] + 0.12) < 1e-12


def check_schemas(bag: Path) -> None:
    with bag.open("rb") as file:
        summary = make_reader(file).get_summary()
    schemas = {schema.name: schema for schema in summary.schemas.values()}
    assert all(schema.encoding == "ros2msg" for schema in schemas.values())
    assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
    assert {"sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/Imu",
            "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage",
            "vision_msgs/msg/Detection2DArray"} == schemas.keys()  # fmt: skip


def main() -> None:
    (WORK / "rig.yaml").write_text(SCENARIO)
    sequence, again = WORK / "rig", WORK / "again"
    for folder in (sequence, again):
        shutil.rmtree(folder, ignore_errors=True)
    make = [LCS, "generate", WORK / "rig.yaml", "--quiet", "--out"]
    subprocess.run([*make, sequence, "--formats", "euroc,tum,kitti,coco"], check=True)
    subprocess.run([*make, sequence, "--formats", "mcap", "--add"], check=True)
    subprocess.run([*make, again, "--formats", "mcap", "--jobs", "2"], check=True)
    bag = sequence / "rosbag"
    assert (bag / "rosbag.mcap").read_bytes() == (again / "rosbag/rosbag.mcap").read_bytes(), "the same bytes"
    manifest = json.loads((sequence / "manifest.json").read_text())
    assert manifest["plan"]["rosbags"] == "0.11.9" and "rosbag/rosbag.mcap" in manifest["files"]
    found = read(bag)
    check_readings(found, sequence / "mav0")
    check_poses(found, sequence)
    check_views(found, sequence)
    check_schemas(bag / "rosbag.mcap")
    # A bag has no truth to start from; neither has the folder then.
    (sequence / "lcs.json").unlink()
    shutil.rmtree(sequence / "mav0/state_groundtruth_estimate0")
    calibration = ("--imu-calibration", str(sequence / "mav0/imu0/sensor.yaml"))
    for i in (0, 1):
        of_bag = replay(LCS, bag, WORK / "out-bag", "--image-topic", f"/cam{i}/image_raw/compressed",
                        "--imu-topic", "/imu0", "--odometry-topic", "/odometry0", *calibration)  # fmt: skip
        of_folder = replay(LCS, sequence, WORK / "out-folder", "--camera", f"cam{i}")
        assert len(of_bag) > 20 and of_bag == of_folder, i
    print("fine: the bag has the sequence, message by message")


if __name__ == "__main__":
    main()
