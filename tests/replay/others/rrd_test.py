#!/usr/bin/env python3
"""rrd_test.py LCS WORK: `lcs generate --formats rrd` of a stereo rig, read by Rerun's own reader: times,
poses, readings, pictures, boxes and pinholes are those of the sequence's other formats. Two recordings of
the same sequence have the same data, and an id that viewers join."""

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import rerun as rr
import yaml

from mcap_test import FRAMES, LCS, SCENARIO, WORK, rows


def read(file: Path) -> tuple[dict, dict]:
    """The columns of each entity by name, with `time` in ns, and those of static rows."""
    timed: dict = {}
    static: dict = {}
    for chunk in rr.chunk.RrdReader(file).stream():
        batch = chunk.to_record_batch()
        columns = (static if chunk.is_static else timed).setdefault(chunk.entity_path, {})
        for name, column in zip(batch.schema.names, batch.columns):
            if name == "time":
                t_ns = np.array(column, "datetime64[ns]").astype(int)
                columns.setdefault(name, []).extend(t_ns.tolist())
            elif name != "rerun.controls.RowId":
                columns.setdefault(name.split(":")[1], []).extend(column.to_pylist())
        assert chunk.is_static or set(chunk.timeline_names) == {"time"}, chunk.entity_path
    return timed, static


def check_poses(world: dict, mav: Path) -> None:
    truth = rows(mav / "state_groundtruth_estimate0/data.csv")
    assert world["time"] == [t for t, _ in truth]
    places = np.array(world["translation"], float).reshape(-1, 3)
    turns = np.array(world["quaternion"], float).reshape(-1, 4)
    T = np.array([row[:7] for _, row in truth])  # px py pz, qw qx qy qz
    for found, expected in ((places, T[:, :3]), (turns, T[:, [4, 5, 6, 3]])):
        assert np.allclose(found, expected, rtol=0, atol=1e-6)  # Rerun has 32 bits


def check_readings(timed: dict, mav: Path) -> None:
    files = {"imu0": ("/imu/angular_velocity_radps", "/imu/specific_force_mps2"),
             "odometry0": ("/odometry/velocity_mps", "/odometry/yaw_rate_radps")}  # fmt: skip
    for folder, entities in files.items():
        expected = rows(mav / folder / "data.csv")
        assert all(timed[entity]["time"] == [t for t, _ in expected] for entity in entities)
        read_back = [sum(lists, []) for lists in zip(*(timed[entity]["scalars"] for entity in entities))]
        assert read_back == [row for _, row in expected] and len(expected) > 50, folder


def check_camera(timed: dict, static: dict, sequence: Path, i: int) -> None:
    mav, at = sequence / f"mav0/cam{i}", f"/world/imu/cam{i}"
    names = [line.split(",") for line in (mav / "data.csv").read_text().splitlines()[1:]]
    pictures = timed[f"{at}/image"]
    assert pictures["time"] == [int(t) for t, _ in names] and len(names) == FRAMES
    for blob, (_, name) in zip(pictures["blob"], names):
        assert bytes(blob[0]) == (mav / "data" / name).read_bytes()
    sensor = yaml.safe_load((mav / "sensor.yaml").read_text())
    f, fv, cx, cy = sensor["intrinsics"]
    pinhole = static[at]
    assert np.allclose(np.reshape(pinhole["image_from_camera"][0], (3, 3)).T,
                       [[f, 0, cx + 0.5], [0, fv, cy + 0.5], [0, 0, 1]])  # fmt: skip
    T_SC = np.reshape(sensor["T_BS"]["data"], (4, 4))
    assert np.allclose(pinhole["translation"][0], T_SC[:3, 3], rtol=0, atol=1e-6)
    coco = json.loads((sequence / ("" if i == 0 else "cam1") / "coco/annotations.json").read_text())
    kinds = {one["id"]: one["name"] for one in coco["categories"]}
    expected = {(a["image_id"] - 1, a["track_id"]): (a["bbox"], f"{kinds[a['category_id']]} {a['track_id']}")
                for a in coco["annotations"]}  # fmt: skip
    boxes = timed[f"{at}/image/boxes"]
    seen = {}
    columns = zip(*(boxes[name] for name in ("class_ids", "centers", "half_sizes", "labels")))
    for k, frame in enumerate(columns):
        for id_, centre, half, label in zip(*(part or [] for part in frame)):
            seen[k, id_] = ([*np.subtract(centre, half), *np.multiply(half, 2)], label)
    assert seen == expected and any(label.startswith("box") for _, label in seen.values())


def main() -> None:
    (WORK / "rig.yaml").write_text(SCENARIO)
    sequence, again = WORK / "rrd-rig", WORK / "rrd-again"
    for folder in (sequence, again):
        shutil.rmtree(folder, ignore_errors=True)
    make = [LCS, "generate", WORK / "rig.yaml", "--quiet", "--out"]
    subprocess.run([*make, sequence, "--formats", "euroc,coco"], check=True)
    subprocess.run([*make, sequence, "--formats", "rrd", "--add"], check=True)
    subprocess.run([*make, again, "--formats", "rrd", "--jobs", "2"], check=True)
    recordings = [folder / "rerun/sequence.rrd" for folder in (sequence, again)]
    program = Path(sys.executable).parent / "rerun"
    subprocess.run([program, "rrd", "verify", *recordings], check=True)
    stores = [rr.chunk.RrdReader(recording).recordings() for recording in recordings]
    assert [len(of) for of in stores] == [1, 1] and stores[0][0].recording_id == stores[1][0].recording_id
    manifest = json.loads((sequence / "manifest.json").read_text())
    assert manifest["plan"]["rerun-sdk"] == rr.__version__ and "rerun/sequence.rrd" in manifest["files"]
    timed, static = read(recordings[0])
    assert (timed, static) == read(recordings[1]), "the same data"
    check_poses(timed["/world/imu"], sequence / "mav0")
    check_readings(timed, sequence / "mav0")
    for i in (0, 1):
        check_camera(timed, static, sequence, i)
    print("fine: the recording has the sequence")


main()
