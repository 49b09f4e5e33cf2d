"""Runs `lcs generate` on small scenes and reads the files that it writes.

Frames: W is the world (z up), C a camera (x right, y down, z forward), S the IMU. `T_AB` takes the
coordinates of a point in B to those in A. Pixels: x right, y down, (0, 0) is the centre of the top-left
one. Lengths are metres, times seconds, angles radians, unless a name says otherwise.
"""

import dataclasses
import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np


@dataclasses.dataclass
class Row:
    """A line of the table: a figure, the range that it may have, and what the figure is of."""

    name: str
    measured: float
    allowed: tuple  # least and most; the measured figure may equal them
    unit: str = "px"
    digits: int = 3  # that the table shows
    note: str = ""  # how much was measured, and what was left out

    @property
    def agrees(self):
        return bool(self.allowed[0] <= self.measured <= self.allowed[1])

    def cells(self):
        """Name, measured, allowed and verdict as the table has them."""
        low, high = self.allowed

        def text(value, sign=""):
            return f"{value:{sign}.{self.digits}g}"

        if low == high:
            allowed = text(low)
        elif low == 0:
            allowed = f"to {text(high)}"
        elif low == -high:
            allowed = f"±{text(high)}"
        else:
            allowed = f"{text(low)} to {text(high)}"
        name = f"{self.name} ({self.note})" if self.note else self.name
        sign = "+" if low < 0 < high else ""
        return (
            name,
            f"{text(self.measured, sign)} {self.unit}".strip(),
            allowed,
            "agrees" if self.agrees else "**DISAGREES**",
        )


def within(name, measured, bound, **more):
    """A row of a figure whose absolute value has a bound."""
    return Row(name, float(measured), (-bound, bound), **more)


def at_most(name, measured, bound, **more):
    """A row of a figure that is at least 0 and has a bound."""
    return Row(name, float(measured), (0.0, bound), **more)


def around(name, measured, expected, tolerance, **more):
    """A row of a figure that is near an expected one."""
    return Row(name, float(measured), (expected - tolerance, expected + tolerance), **more)


@dataclasses.dataclass
class Camera:
    """A camera's intrinsics. lens: "pinhole", "radtan" (k1 k2 p1 p2 k3) or "equidistant" (k1 to k4)."""

    size_px: tuple = (640, 480)
    focal_px: tuple = (420.0, 420.0)
    centre_px: tuple = (319.5, 239.5)
    lens: str = "pinhole"
    distortion: tuple = ()

    @property
    def matrix(self):
        (fx, fy), (cx, cy) = self.focal_px, self.centre_px
        return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])

    def keys(self, **more):
        """Keys of a scenario's `camera`, at the origin of the rover's frame unless told otherwise."""
        keys = {"size": self.size_px, "focal": self.focal_px, "centre": self.centre_px, "position": [0, 0, 0]}
        if self.lens == "radtan":
            keys["distortion"] = self.distortion
        elif self.lens == "equidistant":
            keys["distortion"] = {"equidistant": self.distortion}
        return {**keys, **more}

    def project(self, points_C):
        """Places in the picture, in pixels, of points (n x 3) in front of the camera."""
        points = np.asarray(points_C, float).reshape(-1, 1, 3)
        zero = np.zeros(3)
        if self.lens == "equidistant":
            places_px, _ = cv2.fisheye.projectPoints(
                points, zero, zero, self.matrix, np.array(self.distortion)
            )
        else:
            distortion = np.array(self.distortion) if self.distortion else np.zeros(5)
            places_px, _ = cv2.projectPoints(points, zero, zero, self.matrix, distortion)
        return places_px.reshape(-1, 2)

    def rays(self, pixels):
        """Directions in C, with z = 1, of light that falls on the pixels (n x 2)."""
        pixels = np.asarray(pixels, float).reshape(-1, 1, 2)
        if self.lens == "equidistant":
            # The angle from the axis by Newton's method: r = theta (1 + k1 theta^2 + ... + k4 theta^8).
            x, y = ((pixels.reshape(-1, 2) - self.centre_px) / self.focal_px).T
            r = np.hypot(x, y)
            powers = np.arange(3, 10, 2)
            theta = r.copy()
            for _ in range(20):
                value = theta + sum(k * theta**p for k, p in zip(self.distortion, powers))
                slope = 1 + sum(p * k * theta ** (p - 1) for k, p in zip(self.distortion, powers))
                theta -= (value - r) / slope
            scale = np.where(r > 0, np.tan(theta) / np.maximum(r, 1e-12), 1)
            return np.column_stack([x * scale, y * scale, np.ones_like(x)])
        distortion = np.array(self.distortion) if self.distortion else np.zeros(5)
        to_rounding = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-12)
        ideal = cv2.undistortPointsIter(pixels, self.matrix, distortion, None, None, to_rounding)
        return np.column_stack([ideal.reshape(-1, 2), np.ones(len(pixels))])


def into(T, points):
    """Points (n x 3) by a 4 x 4 matrix."""
    return np.asarray(points) @ T[:3, :3].T + T[:3, 3]


def still_path(duration_s):
    """`ego.path` of a camera that stands 1 m above the ground and looks along x."""
    pose = [0, 0, 1, 0, 0, 0]
    return {"path": [[0, *pose], [duration_s, *pose]]}


class ProgramFailed(Exception):
    """lcs did not make a sequence."""


class Sequence:
    """A folder that `lcs generate` has written, of a scenario with one camera or a rig."""

    def __init__(self, folder):
        self.folder = folder

    def _table(self, path):
        return np.loadtxt(self.folder / path, delimiter=",", comments="#", ndmin=2)

    def stamps_s(self, camera=0):
        """Times of the pictures since the start of the simulation."""
        return np.array([int(path.stem) - 10**18 for path in self._pictures(camera)]) * 1e-9

    def _pictures(self, camera):
        return sorted((self.folder / f"mav0/cam{camera}/data").glob("*.png"))

    def pictures(self, camera=0):
        """Grey levels (sRGB codes) of all pictures, as they are in the files."""
        return [cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in self._pictures(camera)]

    def poses(self, camera=0):
        """T_WC of all pictures (EuRoC's format is needed)."""
        rows = self._table(f"mav0/cam{camera}/pose.csv")[:, 1:].reshape(-1, 3, 4)
        return [np.vstack([row, [0, 0, 0, 1]]) for row in rows]

    def imu(self):
        """Times in s, angular rates in rad/s and accelerations in m/s^2 of all readings, in S."""
        table = self._table("mav0/imu0/data.csv")
        return self._times_s("mav0/imu0/data.csv"), table[:, 1:4], table[:, 4:7]

    def states(self):
        """Times in s, places of S in W, quaternions (w x y z) of S in W, velocities of S in W."""
        table = self._table("mav0/state_groundtruth_estimate0/data.csv")
        times_s = self._times_s("mav0/state_groundtruth_estimate0/data.csv")
        return times_s, table[:, 1:4], table[:, 4:8], table[:, 8:11]

    def _times_s(self, path):
        """The first column by integers: a double lacks the digits for nanoseconds since 1970."""
        lines = (self.folder / path).read_text().splitlines()
        return np.array([int(line.split(",")[0]) - 10**18 for line in lines if line[:1] != "#"]) * 1e-9

    def depths_m(self, k):
        """Depth along the optical axis of frame k; 0 where there is none."""
        return cv2.imread(str(self.folder / f"depth/{k:06}.png"), cv2.IMREAD_UNCHANGED) / 256.0

    def flow_px(self, k):
        """Flow from frame k to k + 1, as Middlebury's file has it."""
        return cv2.readOpticalFlow(str(self.folder / f"flow/middlebury/{k:06}.flo"))

    def kitti_flow_px(self, k):
        """The same by KITTI's file, and where it is valid."""
        # OpenCV's order is blue (valid), green (v), red (u).
        coded = cv2.imread(str(self.folder / f"flow/kitti/{k:06}.png"), cv2.IMREAD_UNCHANGED)
        return (coded[:, :, :0:-1].astype(float) - 2**15) / 64, coded[:, :, 0] == 1

    def events(self):
        """Rows t in s since the start, x, y, p (1: brighter)."""
        table = np.array([line.split() for line in (self.folder / "rpg/events.txt").read_text().splitlines()])
        if not len(table):
            return np.zeros((0, 4))
        # Seconds since 1970 and their fraction apart: a double lacks the digits for both.
        whole, fraction = np.char.partition(table[:, 0], ".")[:, [0, 2]].T
        times_s = (whole.astype(np.int64) - 10**9) + np.char.add("0.", fraction).astype(float)
        return np.column_stack([times_s, table[:, 1:].astype(float)])


class Bench:
    """The program and a folder for its scenes and sequences."""

    def __init__(self, lcs, folder):
        self.lcs = Path(lcs).resolve()
        self.folder = Path(folder)

    def knows(self, key):
        """Whether scenarios of the program have the key."""
        keys = subprocess.run([self.lcs, "run", "--keys"], capture_output=True, text=True, check=True).stdout
        return any(line.startswith(key + ":") for line in keys.splitlines())

    def mujoco(self):
        """The path of the MuJoCo library that the program uses."""
        listed = subprocess.run(["ldd", self.lcs], capture_output=True, text=True, check=True).stdout
        return next(
            line.split("=>")[1].split("(")[0].strip() for line in listed.splitlines() if "libmujoco" in line
        )

    def generate(self, name, scene_xml, scenario, formats):
        """Writes scene and scenario (a dict; JSON is YAML, too), and makes the sequence."""
        print(f"truth: {name}", file=sys.stderr)
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scene.xml").write_text(scene_xml)
        scenario = {
            "purpose": name,
            "scene": "scene.xml",
            "imu": {"preset": "ideal"},
            "image": {"noise": "none"},
            **scenario,
        }
        (folder / f"{name}.yaml").write_text(json.dumps(scenario, indent=1))
        command = [self.lcs, "generate", f"{name}.yaml", "--formats", formats, "--out", "sequence", "--quiet"]
        made = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if made.returncode:
            said = made.stderr.strip()
            raise ProgramFailed(f"lcs generate {name}.yaml ended with {made.returncode}: {said}")
        if made.stderr.strip():
            print(made.stderr.strip(), file=sys.stderr)
        return Sequence(folder / "sequence")


def linear(codes):
    """Light, 0 to 1, of sRGB codes 0 to 255 (IEC 61966-2-1)."""
    share = np.asarray(codes, float) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def quaternion_to_matrix(q):
    """The rotation of a unit quaternion w x y z."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def scene(geoms, assets="", bodies="", extent_m=6):
    """MJCF of geoms of the setting, lit from all sides alike, so that a surface has one brightness."""
    return f"""<mujoco>
  <statistic extent="{extent_m}" center="0 0 1"/>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <default><geom contype="0" conaffinity="0"/></default>
  <asset>
    <material name="dark" rgba=".08 .08 .08 1" specular="0" shininess="0"/>
    <material name="grey" rgba=".45 .45 .45 1" specular="0" shininess="0"/>
    <material name="bright" rgba=".8 .8 .8 1" specular="0" shininess="0"/>
    {assets}
  </asset>
  <worldbody>
    {geoms}
    {bodies}
  </worldbody>
</mujoco>
"""
