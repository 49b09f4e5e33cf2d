"""
Test bench for the Line-Circle-Square filter: sequences with their truth, the filter, comparators, scores, suites.

    import lcs

    scenario = lcs.Scenario(lcs.SCENARIOS / "crossing.yaml", set={"ego.speed": "0.7 m/s"}, seed=7)
    lcs_filter = lcs.Filter(scenario)
    metrics = lcs.score(
        (frame, lcs_filter.step(frame.corners, frame.motion, frame.signatures, picture=frame.grey))
        for frame in lcs.simulate(scenario)
    )
    print(metrics["rebel.f1"])

Pixels have (0, 0) at the centre of the top-left one; all else is in SI units and radians.
"""
from __future__ import annotations
import builtins
from collections.abc import Iterable as _Iterable
import enum
import numpy
import os
from os import PathLike as _PathLike
import pathlib
from pathlib import Path as _Path
from numpy.typing import ArrayLike as _ArrayLike
import typing
from typing import Optional as _Optional, Union as _Union
from . import _core
__all__: list = ['SCENARIOS', 'Camera', 'Detections', 'Detector', 'Error', 'Filter', 'Frame', 'Label', 'Motion', 'Reason', 'Result', 'Scenario', 'Scorer', 'Simulation', 'Truth', 'Verdict', '__version__', 'compare', 'detectors', 'generate', 'kinematics', 'merge', 'replay', 'run', 'score', 'simulate', 'suite', 'tune', 'world', 'worlds']
class Camera:
    """
    A pinhole with square pixels and no distortion: x right, y down, z forward, pixels with
    (0, 0) at the centre of the top-left one.
    """
    def __init__(self, *, focal: float, cx: float, cy: float, width: int, height: int, rate: float = 0.0) -> None:
        """
        focal, cx, cy in pixels; width, height of the picture; rate in Hz, 0 where it is not known.
        """
    def __repr__(self) -> str:
        ...
    @property
    def cx(self) -> float:
        """
        px
        """
    @property
    def cy(self) -> float:
        """
        px
        """
    @property
    def fx(self) -> float:
        """
        px
        """
    @property
    def fy(self) -> float:
        """
        px, as fx
        """
    @property
    def height(self) -> int:
        """
        px
        """
    @property
    def matrix(self) -> numpy.ndarray:
        """
        K, 3 x 3 float64, in pixels.
        """
    @property
    def rate(self) -> float:
        """
        Pictures a second, Hz; 0: not known.
        """
    @property
    def width(self) -> int:
        """
        px
        """
class Detections:
    """
    What somebody's own detector says of a frame.
    """
    def __init__(self, rebels: typing.Any = None, *, boxes: typing.Any = None, ids: typing.Any = None, circles: typing.Any = None, masks: typing.Any = None) -> None:
        """
        rebels: N bool, which of the frame's corners move by themselves; none where not given.
        boxes: M x 4, left, top, right, bottom, pixel edges: a box over columns l to r-1 has left l and right
        r. ids: M whole numbers from 0 on, which stay with their objects from frame to frame.
        masks: in place of boxes, M x H x W bool: the pixels that each covers.
        circles: K x 3, x, y, radius in pixels: groups of rebels, by which false objects are counted.
        Raises TypeError or ValueError for what is none of these. Places and the masks' size are checked
        against the camera by Scorer.add.
        """
class Detector:
    """
    A detector of the bench: lcs, lcs:lab, lcs:cars, klt, homography, dis (tools/comparators/README.md), or a
    program of yours (tools/comparators/PROTOCOL.md). It says the same as by lcs run.
    """
    def __init__(self, scenario: Scenario, name: str = '', *, command: str = '', timeout: float = 30.0) -> None:
        """
        name: of the detector; lcs if not given, with command the name of the program in results.
        command: starts the program, as 'python3 mine.py'. timeout: of each of its answers, s.
        Raises ValueError for an unknown name, Error for a program that does not start.
        """
    def finish(self) -> list[str]:
        """
        After the last frame: ends a program. Returns remarks, a line each.
        """
    def step(self, frame: Frame) -> Result:
        """
        The next frame of a scenario with the same camera; all frames in order.
        Raises Error for a program that ends or answers wrongly.
        """
    @property
    def name(self) -> str:
        ...
class Error(Exception):
    """
    What is wrong, where, and what to do, as the program lcs says it.
    """
class Filter:
    """
    The Line-Circle-Square filter. The same corners, signatures and motions give the same bits.
    """
    @typing.overload
    def __init__(self, scenario: Scenario) -> None:
        """
        With the scenario's camera, preset and settings.
        """
    @typing.overload
    def __init__(self, camera: Camera, preset: str = 'default', *, set: typing.Any = None) -> None:
        """
        preset: default, lab or cars. set: parameters on top of it, by the keys of
        filter/parameters.cpp: {"circle.gap": 0.3}; angles in degrees.
        Raises Error for what is no preset, key or value, ValueError for a camera that is none.
        """
    def step(self, corners: typing.Any, motion: Motion, signatures: typing.Any = None, *, picture: typing.Any = None) -> Result:
        """
        The next frame.

        corners: N x 2, x and y in pixels; motion: since the last frame; signatures: N x 32 uint8;
        picture: height x width uint8, grey, without distortion. Bodies that approach at constant speed are
        found only with pictures, and only by the preset default.
        Raises TypeError or ValueError for arrays that are none of these, and is then as if the frame had
        not been given. Bad numbers never raise: they are left out, see diagnostics.
        """
    @property
    def diagnostics(self) -> list[str]:
        """
        What was wrong with the data so far, a line for each kind.
        """
class Frame:
    """
    What the sensors said, and apart from that what is true. Arrays are read-only and stay as they are
    when the simulation goes on; those of pictures are views.
    """
    def __repr__(self) -> str:
        ...
    @property
    def corners(self) -> numpy.ndarray:
        """
        N x 2 float64, x and y in pixels: FAST's.
        """
    @property
    def grey(self) -> numpy.ndarray:
        """
        H x W uint8: what the corners were found in.
        """
    @property
    def imu(self) -> numpy.ndarray:
        """
        Readings since the last frame, fields t (s), gyro (3, rad/s), accel (3, m/s^2), in the
        IMU's frame; none of a recorded frame.
        """
    @property
    def index(self) -> int:
        """
        From 0.
        """
    @property
    def motion(self) -> Motion:
        """
        Motion since the last frame, as detectors are told: by the IMU and the odometry, with
        their errors, unless the scenario says otherwise.
        """
    @property
    def noise(self) -> float | None:
        """
        Standard deviation of the noise of grey, in grey levels; None where all flat parts are black or white.
        """
    @property
    def odometry(self) -> numpy.ndarray:
        """
        Likewise, fields t (s), velocity (3, m/s, of the rover in its frame: x forward, z up),
        yaw_rate (rad/s, by the wheels; nan where they do not tell it).
        """
    @property
    def picture(self) -> numpy.ndarray:
        """
        H x W x 3 uint8, blue, green, red, as OpenCV has it; picture[..., ::-1] is RGB.
        """
    @property
    def signatures(self) -> numpy.ndarray:
        """
        N x 32 uint8: what each corner looks like, ORB's bits.
        """
    @property
    def time(self) -> float:
        """
        s
        """
    @property
    def time_ns(self) -> int:
        """
        ns
        """
    @property
    def truth(self) -> Truth:
        """
        What no detector is to be told.
        """
class Label(enum.IntEnum):
    """
    What is true of a corner (tools/scoring/SCORING.md).
    """
    FIXED: typing.ClassVar[Label]
    INDISTINCT: typing.ClassVar[Label]
    NONE: typing.ClassVar[Label]
    REBEL: typing.ClassVar[Label]
    _member_map_: typing.ClassVar[dict]
    _member_names_: typing.ClassVar[list] = ['NONE', 'FIXED', 'INDISTINCT', 'REBEL']
    _unhashable_values_: typing.ClassVar[list] = list()
    _use_args_: typing.ClassVar[bool] = True
    _value2member_map_: typing.ClassVar[dict]
    _member_type_ = builtins.int
    @staticmethod
    def _generate_next_value_(name, start, count, last_values):
        """
                Generate the next value when not given.

                name: the name of the member
                start: the initial start value or None
                count: the number of existing members
                last_values: the list of values assigned

        """
    @staticmethod
    def _new_member_(type, *args, **kwargs):
        """
        Create and return a new object.  See help(type) for accurate signature.
        """
    @classmethod
    def __new__(cls, value):
        ...
    def __format__(self, format_spec):
        ...
    def _value_repr_(self):
        """
        Return repr(self).
        """
class Motion:
    """
    How the camera moved from the last frame to this one. Camera frame: x right, y down, z
    forward.
    """
    @staticmethod
    def between(T_WC_before: typing.Any, T_WC_now: typing.Any, dt: float) -> Motion:
        """
        Of two poses of the camera, 4 x 4, that are dt seconds apart.
        """
    def __init__(self, *, dt: float, rotation: typing.Any = None, velocity: typing.Any = None, angular_velocity: typing.Any = None, up: typing.Any = None, height: float | None = None, unseen_turn: float = 0.0, velocity_sigma: float = 0.0) -> None:
        """
        dt in s; rotation 3 x 3, none where not given; velocity 3, m/s, of the camera in its frame of now;
        angular_velocity 3, rad/s, that of the rotation where not given; up and height: the ground, see
        there; unseen_turn in rad, velocity_sigma in m/s.
        """
    def __repr__(self) -> str:
        ...
    @property
    def angular_velocity(self) -> numpy.ndarray:
        """
        3, rad/s: mean body rate of the camera.
        """
    @property
    def displacement(self) -> numpy.ndarray:
        """
        3, m: of the camera since the last frame, in its frame of now.
        """
    @property
    def dt(self) -> float:
        """
        Time since the last frame, s; 0 in the first one.
        """
    @property
    def height(self) -> float | None:
        """
        m: of the camera above the ground; None where not known.
        """
    @property
    def rotation(self) -> numpy.ndarray:
        """
        3 x 3: takes camera coordinates of the last frame to those of this one.
        """
    @property
    def unseen_turn(self) -> float:
        """
        rad: standard deviation of what is wrong with the rotation where the gyro was
        not heard; 0 where it was.
        """
    @property
    def up(self) -> typing.Any:
        """
        3: unit normal of the ground, against gravity, in the camera's frame; None where not known.
        """
    @property
    def usable(self) -> bool:
        """
        Whether a filter can go on by it from the last frame; it starts anew where not.
        False for the first frame.
        """
    @property
    def velocity(self) -> numpy.ndarray:
        """
        3, m/s: mean velocity of the camera since the last frame, in its frame of now.
        """
    @property
    def velocity_sigma(self) -> float:
        """
        m/s: standard deviation of what is wrong with the velocity; 0 where nobody tells.
        """
class Reason(enum.IntEnum):
    """
    Which of the filter's rules settled a corner's verdict (filter/reason.h).
    """
    ALPHA_BEND: typing.ClassVar[Reason]
    ALPHA_FIRST: typing.ClassVar[Reason]
    ALPHA_ON_FIELD: typing.ClassVar[Reason]
    ALPHA_SECOND: typing.ClassVar[Reason]
    ALPHA_TAKEN: typing.ClassVar[Reason]
    ALPHA_THIRD: typing.ClassVar[Reason]
    COMER: typing.ClassVar[Reason]
    FIRST_SIGHTING: typing.ClassVar[Reason]
    GOER: typing.ClassVar[Reason]
    INHERITED: typing.ClassVar[Reason]
    IN_PSI: typing.ClassVar[Reason]
    NORMAL_EDGE: typing.ClassVar[Reason]
    NORMAL_NEIGHBOURS: typing.ClassVar[Reason]
    NOT_FINITE: typing.ClassVar[Reason]
    NO_TIME: typing.ClassVar[Reason]
    OUTBID: typing.ClassVar[Reason]
    OUTSIDE: typing.ClassVar[Reason]
    REBEL_EDGE: typing.ClassVar[Reason]
    REBEL_NEIGHBOURS: typing.ClassVar[Reason]
    TOO_MANY: typing.ClassVar[Reason]
    UNKNOWN: typing.ClassVar[Reason]
    XI_1: typing.ClassVar[Reason]
    XI_2: typing.ClassVar[Reason]
    XI_3: typing.ClassVar[Reason]
    XI_4: typing.ClassVar[Reason]
    XI_5: typing.ClassVar[Reason]
    _member_map_: typing.ClassVar[dict]
    _member_names_: typing.ClassVar[list] = ['UNKNOWN', 'NOT_FINITE', 'OUTSIDE', 'TOO_MANY', 'IN_PSI', 'NO_TIME', 'NORMAL_EDGE', 'REBEL_EDGE', 'NORMAL_NEIGHBOURS', 'REBEL_NEIGHBOURS', 'COMER', 'GOER', 'INHERITED', 'FIRST_SIGHTING', 'ALPHA_FIRST', 'XI_5', 'XI_4', 'OUTBID', 'XI_1', 'ALPHA_SECOND', 'ALPHA_BEND', 'ALPHA_ON_FIELD', 'ALPHA_TAKEN', 'ALPHA_THIRD', 'XI_3', 'XI_2']
    _unhashable_values_: typing.ClassVar[list] = list()
    _use_args_: typing.ClassVar[bool] = True
    _value2member_map_: typing.ClassVar[dict]
    _member_type_ = builtins.int
    @staticmethod
    def _generate_next_value_(name, start, count, last_values):
        """
                Generate the next value when not given.

                name: the name of the member
                start: the initial start value or None
                count: the number of existing members
                last_values: the list of values assigned

        """
    @staticmethod
    def _new_member_(type, *args, **kwargs):
        """
        Create and return a new object.  See help(type) for accurate signature.
        """
    @classmethod
    def __new__(cls, value):
        ...
    def __format__(self, format_spec):
        ...
    def _value_repr_(self):
        """
        Return repr(self).
        """
class Result:
    """
    What a detector says of a frame. Structured arrays have the fields of layers.jsonl; places are in
    pixels, angles in rad, speeds in px/s.
    """
    @property
    def boxes(self) -> numpy.ndarray:
        """
        M x 4 float64: left, top, right, bottom of the squares, pixel edges.
        """
    @property
    def circles(self) -> numpy.ndarray:
        """
        Groups of edges: id, rebel, x, y, radius, speed, angle, trust, age, members, ...
        """
    @property
    def collectors(self) -> numpy.ndarray:
        """
        Regions lambda: x, y, radius, depth_ratio.
        """
    @property
    def edges(self) -> numpy.ndarray:
        """
        Tracked corners, normal and then rebel ones: id, rebel, x, y, trust, age, speed, angle, corner
        (its place in the corners, -1 none), circle (its place among the circles of its kind, -1 none), ...
        """
    @property
    def ignored(self) -> numpy.ndarray:
        """
        Regions psi whose corners were not looked at: shape (1 circle, 2 rectangle), x, y, size_x,
        size_y.
        """
    @property
    def outlines(self) -> list:
        """
        Of each square K x 2 float64: x, y of the convex hull of its edges, clockwise as the
        picture is seen; none of the presets lab and cars.
        """
    @property
    def reasons(self) -> numpy.ndarray:
        """
        N uint8, a Reason for each verdict.
        """
    @property
    def rebels(self) -> numpy.ndarray:
        """
        N bool: the corners that move by themselves.
        """
    @property
    def squares(self) -> numpy.ndarray:
        """
        Objects: id, x, y, half_width, half_height, speed, angle, trust, age, circles,
        rebel_circles, ...
        """
    @property
    def verdicts(self) -> numpy.ndarray:
        """
        N uint8, a Verdict for each corner.
        """
class Scenario:
    """
    What is simulated, or what was recorded: a YAML file as scenarios/README.md has it.
    """
    @staticmethod
    def from_yaml(text: str, *, file: str | os.PathLike[str] = ..., set: typing.Any = None, seed: typing.Any = None) -> Scenario:
        """
        The same of text. file: that it might be, which gives the name; paths begin at its folder.
        """
    def __init__(self, file: str | os.PathLike[str], *, set: typing.Any = None, seed: typing.Any = None) -> None:
        """
        Reads and checks all of it.

        set: values in place of the file's, as lcs run --set takes them: {"ego.speed": "0.7 m/s"}.
        seed: in place of the file's.
        Raises Error with file, line, what is wrong and what to do. Warns of settings of the filter that
        have no effect.
        """
    def __repr__(self) -> str:
        ...
    @property
    def camera(self) -> Camera:
        ...
    @property
    def file(self) -> pathlib.Path:
        ...
    @property
    def frames(self) -> int:
        """
        How many; of a recording at the most.
        """
    @property
    def groups(self) -> list[str]:
        """
        That it belongs to, as "short".
        """
    @property
    def name(self) -> str:
        """
        The file's stem.
        """
    @property
    def purpose(self) -> str:
        """
        One line.
        """
    @property
    def recorded(self) -> bool:
        """
        Whether the frames are those of a recording, not of a simulation.
        """
    @property
    def seed(self) -> int:
        ...
class Scorer:
    """
    Scores a run's frames, one after another, without keeping their pictures.
    """
    def __init__(self) -> None:
        ...
    def add(self, frame: Frame, said: typing.Any) -> None:
        """
        said: a Result of the filter or of a Detector, Detections, or N bool, which of the frame's corners are rebels.
        Frames come in order, each once, from the first on; what raises counts for nothing.
        Raises ValueError for what is not in the camera's picture (tools/recording/DETECTIONS.md).
        """
    def metrics(self) -> dict:
        """
        All figures of metrics.json (tools/scoring/SCORING.md) by name; None where undefined. Times and
        sizes are those of the filter; of other detectors they are None.
        """
    @property
    def warnings(self) -> list[str]:
        """
        What should not be, a line each, as lcs run tells it.
        """
class Simulation:
    """
    The frames of a scenario, one after another. To be used by the thread that made it; other
    threads run meanwhile. The same scenario and seed give the same bits.
    """
    def __init__(self, scenario: Scenario) -> None:
        ...
    def __iter__(self) -> typing.Any:
        ...
    def __next__(self) -> Frame:
        ...
    @property
    def scenario(self) -> Scenario:
        ...
    @property
    def warnings(self) -> list[str]:
        """
        What should not be, until now, a line each: the rover or an actor ran into something, fell,
        tipped over.
        """
class Truth:
    """
    What is true of a frame, as tools/scoring/SCORING.md defines it. Of a recorded frame there are
    labels alone, and motion, depth, object_ids and poses raise ValueError.
    """
    def of(self, points: typing.Any) -> numpy.ndarray:
        """
        The same of other points, N x 2 in pixels: for corners of one's own.
        """
    @property
    def T_WC(self) -> numpy.ndarray:
        """
        4 x 4: takes camera coordinates to the world's (z up), m.
        """
    @property
    def T_WO(self) -> numpy.ndarray:
        """
        K x 4 x 4: likewise of the object with that id; 0 is the world itself.
        """
    @property
    def boxes(self) -> numpy.ndarray:
        """
        M x 4 float64: left, top, right, bottom of these, pixel edges.
        """
    @property
    def corners(self) -> numpy.ndarray:
        """
        A row for each of the frame's corners: label, radial, outline, object (its id; 0 the
        fixed setting, -1 none), depth_m, motion_x, motion_y (px until the next frame),
        static_motion_x, static_motion_y (px: as if it were fixed).
        """
    @property
    def depth(self) -> numpy.ndarray:
        """
        H x W float32: z-depth, m; inf where there is sky.
        """
    @property
    def labels(self) -> numpy.ndarray:
        """
        N uint8, a Label for each of the frame's corners.
        """
    @property
    def motion(self) -> Motion:
        """
        Motion since the last frame by the exact poses.
        """
    @property
    def names(self) -> dict[int, str]:
        """
        Of all objects, by id.
        """
    @property
    def object_ids(self) -> numpy.ndarray:
        """
        H x W int32: id of the object that a pixel shows; 0 the fixed setting, -1 sky and the rover.
        """
    @property
    def objects(self) -> numpy.ndarray:
        """
        A row for each object that is seen: object (its id), left, top, right, bottom (pixel
        edges of what is seen of it), visible_px, visible_fraction, moving.
        """
class Verdict(enum.IntEnum):
    """
    What became of a corner.
    """
    IGNORED: typing.ClassVar[Verdict]
    NORMAL: typing.ClassVar[Verdict]
    PENDING: typing.ClassVar[Verdict]
    REBEL: typing.ClassVar[Verdict]
    _member_map_: typing.ClassVar[dict]
    _member_names_: typing.ClassVar[list] = ['IGNORED', 'PENDING', 'NORMAL', 'REBEL']
    _unhashable_values_: typing.ClassVar[list] = list()
    _use_args_: typing.ClassVar[bool] = True
    _value2member_map_: typing.ClassVar[dict]
    _member_type_ = builtins.int
    @staticmethod
    def _generate_next_value_(name, start, count, last_values):
        """
                Generate the next value when not given.

                name: the name of the member
                start: the initial start value or None
                count: the number of existing members
                last_values: the list of values assigned

        """
    @staticmethod
    def _new_member_(type, *args, **kwargs):
        """
        Create and return a new object.  See help(type) for accurate signature.
        """
    @classmethod
    def __new__(cls, value):
        ...
    def __format__(self, format_spec):
        ...
    def _value_repr_(self):
        """
        Return repr(self).
        """
def compare(before: str | os.PathLike[str], after: str | os.PathLike[str], *, metric: str = '', markdown: str = '', pictures_at: str = '') -> dict:
    """
    The differences of two suites, beyond the noise of their seeds (tools/suite/README.md).

    before, after: folders, or their suite.json. metric: a regular expression.
    markdown: a folder for a summary in Markdown, whose pictures will be at the address pictures_at.
    Returns a dict: verdict, a line; regressed; means and scenarios: a dict for each figure, with group
    or scenario, metric, before, after, change, half (of its 95 % interval; None where unknown), pairs,
    verdict (improved, regressed, moved, unknown, or none); incomparable; text: as the program prints it.
    Raises Error for suites that cannot be read, or have nothing in common.
    """
def detectors() -> dict:
    """
    The names of the bench's detectors, with a line on each.
    """
def generate(paths: typing.Any = None, *, out: str = '', worlds: str = '', count: int = 60, family: str = '', suite: bool = False, formats: list[str] = [], frames: int = 0, seed: int | None = None, seeds: int = 1, set: typing.Any = None, jobs: int = 1, shard: str = '', progress: typing.Any = None) -> dict:
    """
    Writes a scenario as a sequence that other tools read (tools/sequence/README.md).

    paths: the scenario's file; with suite=True files and folders. worlds: in its place a split of
    worlds, as in suite. formats: names, all if not given. frames: only the first so many.
    Returns a dict: folders; errors, of many; frames (first, last + 1) and notes, of one; messages. The
    same call goes on after it was interrupted.
    """
def kinematics(config: str = '', *, set: typing.Any = None, tolerance: float = 1.0, quick: bool = False, out: str | os.PathLike[str] = 'out/kinematics', progress: typing.Any = None) -> dict:
    """
    Measures when the motion model holds for a camera and rover (tools/kinematics/README.md).

    config: a scenario's file; crossing.yaml if not given. tolerance: of a prediction, px.
    Returns a dict: folder; answer: for each topic a dict of text, figures (name, value, unit, expected,
    NaN without theory) and verdict; text: as the program prints it.
    """
def merge(parts: typing.Any, *, out: str | os.PathLike[str] = 'out/suite', baseline: str = '') -> dict:
    """
    Joins the folders of the parts of a suite (shard). Returns as suite.
    """
def replay(path: str | os.PathLike[str], *, out: str = '', recording: typing.Any = None, ego_motion: str = '', fast_threshold: str = '', preset: str = '', set: typing.Any = None, detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, beside: list[str] = [], video: bool = False, events: bool = False, progress: typing.Any = None) -> dict:
    """
    Runs a detector on a recording (tools/replay/README.md), and writes the folder of lcs replay.

    path: a folder, video or ROS bag. recording: keys of a scenario's recording, as {"focal": 600,
    "topics.imu": "/imu"}; lists as text, "319.5,239.5". ego_motion: imu or truth. fast_threshold:
    contrast of a corner, 1 to 254 grey levels, or auto. Returns as run.
    """
def run(scenario: str | os.PathLike[str], *, out: str = '', seed: int | None = None, set: typing.Any = None, frames: str = '', detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, detections: str = '', beside: list[str] = [], recorded: str = '', keep: str = 'all', video: bool = False, events: bool = False, report: bool = False, progress: typing.Any = None) -> dict:
    """
    Runs a scenario's file and writes the folder of lcs run, out/SCENARIO if not given.

    beside: "DETECTOR=FOLDER" each. The others are as those of suite.
    Returns a dict: scenario, seed, detectors (by name a dict of metrics, criteria, folder), messages.
    """
def score(said: _Union[str, _PathLike[str], _Iterable[tuple[Frame, _Union[Result, Detections, _ArrayLike]]]], *, detections: _Union[str, _PathLike[str]] = '') -> dict[str, _Optional[float]]:
    """
    The figures of metrics.json, by name; None where undefined.

        said: pairs of a Frame and what a detector says of it: a Result, Detections, or N bool, which of
        frame.corners are rebels. All frames of one run, in order. Or the folder of a stored run;
        detections: then a CSV file of another detector (tools/recording/DETECTIONS.md).

    """
def simulate(scenario: Scenario) -> Simulation:
    """
    The frames of a Scenario, one after another; of a recorded one, what was recorded.

        Raises Error for what cannot be simulated, at once or, of physics that fail, in the frame where
        they do.

    """
def suite(paths: typing.Any = None, *, worlds: str = '', count: int = 60, family: str = '', group: str | None = None, filter: str = '', seeds: int | None = None, jobs: int = 0, detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, beside: list[str] = [], set: typing.Any = None, recorded: str = '', detections: str = '', keep: str = 'all', shard: str = '', times: str = '', out: str | os.PathLike[str] = 'out/suite', baseline: str = '', anew: bool = False, progress: typing.Any = None) -> dict:
    """
    Runs many scenarios, each in a process of its own, as lcs suite does with the options of these names.

    paths: scenario files and folders; worlds: in their place a split, train, validate or test, of
    which count worlds, of one family where given; neither: the project's short scenarios.
    seeds: runs of each, 3, of worlds 1. jobs: at a time, as many as processors.
    detector, beside: names (detectors()). detector_command: starts a program of yours;
    detector_timeout: of its answers, s. set: as in Scenario. recorded: an earlier suite, for its frames.
    keep: figures, events or all. baseline: an earlier suite. progress: called with the numbers of
    finished and of all runs.

    Returns a dict: folder; outcome (passed, failed, error); runs: a dict each, with detector,
    scenario, seed, family, outcome, error, metrics (by name), criteria, folder, command; means: a
    dict for each detector, group and metric of the program's tables, with mean, half (of the 95 %
    interval, of worlds; None where unknown) and count; table: the text that the program prints; verdict;
    comparison with the baseline, as of compare; messages.
    Finished runs are kept if it raises or is interrupted, and the same call goes on from there.
    """
def tune(suites: typing.Any, *, validate: typing.Any = None, keys: list[str] = [], set: typing.Any = None, evaluations: int = 300, seed: int = 1, out: str | os.PathLike[str] = 'out/tune', progress: typing.Any = None) -> dict:
    """
    Learns the filter's parameters from suites of the split train, as lcs tune.

    suites, validate: folders. keys: of the parameters; all learnt ones if not given.
    Returns a dict: folder; before, after: values by key; stated: for each kind of suites a dict of suite
    and, before and after, objective, f1, false objects and corners a frame; evaluations; record, a text.
    The same call goes on after it was interrupted.
    """
def world(family: str, seed: int = 1, *, out: str = '', pictures: str = '', sheet: bool = False) -> dict:
    """
    Draws a scenario and its scene from a seed, and writes them (tools/worlds/README.md).

    out: folder; out/worlds/FAMILY_SEED if not given. pictures: folder of pictures for surfaces.
    Returns a dict: file (the scenario), objects, movers, drawn_again (times), features.
    Raises ValueError for an unknown family, naming the known ones.
    """
def worlds(split: str, count: int = 60, *, family: str = '', jobs: int = 0) -> list[pathlib.Path]:
    """
    The scenario files of the first worlds of a split: train, validate or test, by which nothing may be
    chosen. Those that are missing in out/worlds/ are drawn, jobs at a time.
    """
SCENARIOS: pathlib.Path
__version__: str
