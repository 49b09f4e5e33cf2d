#!/usr/bin/env python3
"""Writes the messages of a generated sequence as a recording of Rerun: write_rrd.py MESSAGES SEQUENCE OUT

MESSAGES and SEQUENCE are those of write_bag.py. OUT is a new folder, which gets sequence.rrd, with a layout
of its views. With --version alone it prints the version of rerun-sdk, which it needs. Rerun puts the time of
writing into the ids of its rows, so that the bytes of two recordings with the same data differ.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path
from typing import Any

try:
    import numpy as np
    import rerun as rr
    import rerun.blueprint as rrb
except ImportError:
    print("writing Rerun's recordings needs the Python package rerun-sdk; install it with: "
          f"{sys.executable} -m pip install rerun-sdk==0.41.0", file=sys.stderr)  # fmt: skip
    sys.exit(3)

TIME = "time"
# A list of messages, the columns of its rows after the time, and the entity of each group of them.
CURVES = {
    "imu": {"imu/angular_velocity_radps": "xyz", "imu/specific_force_mps2": "xyz"},
    "wheels": {"odometry/velocity_mps": "xyz", "odometry/yaw_rate_radps": "z"},
}


def times(t_ns: list[int]) -> list[rr.TimeColumn]:
    return [rr.TimeColumn(TIME, timestamp=np.array(t_ns, "datetime64[ns]"))]


def transform(T: list[float]) -> rr.Transform3D:
    return rr.Transform3D(translation=T[:3], quaternion=T[3:])


def camera_at(place: int) -> str:
    return f"world/imu/cam{place}"


def log_cameras(stream: rr.RecordingStream, sensors: dict) -> None:
    """T_SB of the rover, and T_SC and the pinhole of each camera, whose frame is x right, y down, z ahead."""
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    stream.log("world/imu/base", transform(sensors["links"]["base"]), static=True)
    for place, camera in enumerate(sensors["cameras"]):
        fu, fv, cu, cv = camera["intrinsics"]
        # Rerun has (0.5, 0.5) at the centre of the first pixel.
        pinhole = rr.Pinhole(image_from_camera=[[fu, 0, cu + 0.5], [0, fv, cv + 0.5], [0, 0, 1]],
                             resolution=[camera["width"], camera["height"]],
                             camera_xyz=rr.ViewCoordinates.RDF, image_plane_distance=0.5)  # fmt: skip
        stream.log(camera_at(place), transform(sensors["links"][camera["frame"]]), pinhole, static=True)
        if any(camera["distortion"]):
            lens = f"{camera['model']} {camera['distortion']}"
            said = rr.TextDocument(f"Rerun's pinhole lacks the distortion of the pictures: {lens}")
            stream.log(f"{camera_at(place)}/distortion", said, static=True)


def log_view(stream: rr.RecordingStream, folder: Path, frame: dict) -> None:
    """The picture, and boxes by pixel edges, each with its object's id and name of kind."""
    stream.set_time(TIME, timestamp=np.datetime64(frame["t"], "ns"))
    at = f"{camera_at(frame['place'])}/image"
    stream.log(at, rr.EncodedImage(contents=(folder / frame["picture"]).read_bytes(), media_type="image/png"))
    ids, kinds, *edges = zip(*frame["boxes"]) if frame["boxes"] else [[]] * 6
    left, top, right, bottom = np.array(edges, float)
    stream.log(f"{at}/boxes", rr.Boxes2D(
        mins=np.stack([left, top], 1), sizes=np.stack([right - left, bottom - top], 1), class_ids=ids,
        labels=[f"{kind} {id_}" for id_, kind in zip(ids, kinds)]))  # fmt: skip


def send_rows(stream: rr.RecordingStream, rows: dict[str, list]) -> None:
    """Readings of the IMU and the wheels, and exact poses T_WS of the IMU."""
    places, turns = np.split(np.array([row[1:] for row in rows["states"]]), [3], axis=1)
    # Of q and -q, which are the same rotation, the one nearer to the row before.
    turns[1:] *= np.cumprod(np.where(np.sum(turns[1:] * turns[:-1], axis=1) < 0, -1, 1))[:, None]
    stream.send_columns("world/imu", times([row[0] for row in rows["states"]]),
                        rr.Transform3D.columns(translation=places, quaternion=turns))  # fmt: skip
    stream.log("world/path", rr.LineStrips3D([places]), static=True)
    for key, entities in CURVES.items():
        if not rows[key]:
            continue
        t_ns, values = [row[0] for row in rows[key]], np.array([row[1:] for row in rows[key]])
        for entity, axes in entities.items():
            part, values = np.split(values, [len(axes)], axis=1)
            stream.log(entity, rr.SeriesLines(names=list(axes)), static=True)
            lengths = [len(axes)] * len(t_ns)
            columns = rr.Scalars.columns(scalars=part.ravel()).partition(lengths)
            stream.send_columns(entity, times(t_ns), columns)


def layout(sensors: dict, rows: dict[str, list]) -> rrb.Blueprint:
    views = [rrb.Spatial2DView(origin=f"{camera_at(place)}/image", name=f"cam{place}")
             for place in range(len(sensors["cameras"]))]  # fmt: skip
    curves = [rrb.TimeSeriesView(origin=entity) for key, entities in CURVES.items() if rows[key]
              for entity in entities]  # fmt: skip
    seen = rrb.Horizontal(rrb.Spatial3DView(origin="world"), rrb.Vertical(*views))
    return rrb.Blueprint(rrb.Vertical(seen, rrb.Horizontal(*curves), row_shares=[2, 1]), collapse_panels=True)


def write(messages: Path, folder: Path, out: Path) -> None:
    out.mkdir()
    rows: dict[str, list[Any]] = {"imu": [], "states": [], "wheels": []}
    # Viewers join recordings with the same id.
    identity = hashlib.sha256(messages.read_bytes()).hexdigest()
    with rr.RecordingStream("lcs", recording_id=identity, send_properties=False) as stream, \
            messages.open() as lines:  # fmt: skip
        stream.set_log_time_enabled(False)  # the time of writing
        stream.save(out / "sequence.rrd")
        sensors = json.loads(next(lines))
        log_cameras(stream, sensors)
        for line in lines:
            frame = json.loads(line)
            log_view(stream, folder, frame)
            for key, found in rows.items():
                found += frame.get(key, [])
        stream.reset_time()
        send_rows(stream, rows)
        stream.send_blueprint(layout(sensors, rows))
        stream.disconnect()


def main(words: list[str]) -> int:
    if words == ["--version"]:
        print(rr.__version__, end="")
        return 0
    try:
        write(*map(Path, words))
        return 0
    except Exception as fault:  # of any type: Rerun passes its libraries' exceptions on
        print(f"the recording was not written ({type(fault).__name__}: {fault})", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
