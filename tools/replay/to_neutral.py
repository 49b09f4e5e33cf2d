#!/usr/bin/env python3
"""Turns a recording into the folder of NEUTRAL.md; change it where yours differs.

to_neutral.py OUT --pictures DIR --times FILE --camera W H FX FY CX CY [--poses FILE | --imu FILE]

Columns count from 0: time; x y z qx qy qz qw; rates, accelerations. Rows whose time is no number are
skipped. --axes: where x, y and z of the poses' camera point; --inverse: poses of the world in it;
--forces=-g: as iOS has them; --camera-on-imu: T_BS, row by row.
"""

import argparse
import re
from decimal import Decimal
from pathlib import Path

import numpy as np

UNITS_NS = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}
SIDES = {"right": (1, 0, 0), "down": (0, 1, 0), "ahead": (0, 0, 1),
         "left": (-1, 0, 0), "up": (0, -1, 0), "back": (0, 0, -1)}  # fmt: skip
RATES, FORCES = {"rad/s": 1, "deg/s": np.pi / 180}, {"m/s^2": 1, "g": 9.80665, "-g": -9.80665}


def write(file, header, rows):
    file.write_text("\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n")


def camera_pose(row, axes, is_inverse):
    """x y z qx qy qz qw of a camera whose x, y and z are to the right, down and ahead."""
    p, (*v, w) = row[:3], row[3:] / np.linalg.norm(row[3:])
    S = np.cross(v, np.eye(3)).T  # S a is v x a
    R = np.eye(3) + 2 * w * S + 2 * S @ S
    R, p = (R.T, -R.T @ p) if is_inverse else (R, p)
    mirror = np.diag([1, np.linalg.det(axes), 1])
    R, p = mirror @ R @ axes.T, mirror @ p
    K = np.zeros((4, 4))  # of it the quaternion is the last eigenvector
    K[:3, :3], K[3, 3] = R + R.T - np.trace(R) * np.eye(3), np.trace(R)
    K[3, :3] = K[:3, 3] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    return *p, *np.linalg.eigh(K)[1][:, 3]


parse = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parse.add_argument("out", type=Path)
parse.add_argument("--pictures", type=Path, required=True)
for name, count in (("times", 1), ("poses", 8), ("imu", 7)):
    parse.add_argument(f"--{name}", type=Path, required=name == "times")
    parse.add_argument(f"--{name}-columns", type=int, nargs="+", default=range(count))
    parse.add_argument(f"--{name}-unit", choices=UNITS_NS, default="s")
parse.add_argument("--axes", nargs=3, choices=SIDES, default=["right", "down", "ahead"])
parse.add_argument("--inverse", action="store_true")
parse.add_argument("--rates", choices=RATES, default="rad/s")
parse.add_argument("--forces", choices=FORCES, default="m/s^2")
parse.add_argument("--camera", type=float, nargs=6, required=True)
parse.add_argument("--camera-on-imu", type=float, nargs=16)
asked = parse.parse_args()


def rows_of(name):
    """Times in ns, without rounding through a float, and the other columns as numbers."""
    file, columns, unit = (getattr(asked, name + part) for part in ("", "_columns", "_unit"))
    for line in file.read_text().splitlines() if file else ():
        fields = re.split(r"[,;\s]+", line.strip())
        if len(fields) > max(columns) and re.match(r"[-+.\d]", time := fields[columns[0]]):
            if not re.fullmatch(r"[-+]?\d+\.?\d*", time):
                raise SystemExit(f"{file}: the time {time} is rounded; give all digits")
            yield int(Decimal(time) * UNITS_NS[unit]), np.array([float(fields[c]) for c in columns[1:]])


pictures = sorted(asked.pictures.iterdir(), key=lambda p: list(map(int, re.findall(r"\d+", p.name))))
times = [t for t, _ in rows_of("times")]
if len(pictures) != len(times):
    raise SystemExit(f"{len(pictures)} pictures and {len(times)} times: give one for each")
names = [f"{k:06}{picture.suffix}" for k, picture in enumerate(pictures)]
(asked.out / "pictures").mkdir(parents=True)
for picture, name in zip(pictures, names):
    (asked.out / "pictures" / name).write_bytes(picture.read_bytes())
write(asked.out / "times.csv", "time_ns,picture", zip(times, names))
if asked.poses:
    axes = np.array([SIDES[side] for side in asked.axes]).T
    write(asked.out / "poses.csv", "time_ns,x,y,z,qx,qy,qz,qw",
          ([t, *camera_pose(row, axes, asked.inverse)] for t, row in rows_of("poses")))  # fmt: skip
if asked.imu:
    scale = np.repeat([RATES[asked.rates], FORCES[asked.forces]], 3)
    write(asked.out / "imu.csv", "#timestamp [ns],w_RS_S_x,w_RS_S_y,w_RS_S_z,a_RS_S_x,a_RS_S_y,a_RS_S_z",
          ([t, *(scale * row)] for t, row in rows_of("imu")))  # fmt: skip
width, height, *lens = asked.camera
yaml = [[f"resolution: [{width:.0f}, {height:.0f}]"], [f"intrinsics: {lens}"], ["distortion_model: none"]]
if asked.camera_on_imu:
    yaml.append([f"T_BS: {np.reshape(asked.camera_on_imu, (4, 4)).tolist()}"])
write(asked.out / "calibration.yaml", "camera_model: pinhole", yaml)
