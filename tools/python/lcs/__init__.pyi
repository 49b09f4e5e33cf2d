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
import collections.abc
from collections.abc import Iterable as _Iterable
import enum
import numpy
import numpy.typing
import os
from os import PathLike as _PathLike
import pathlib
from pathlib import Path as _Path
from numpy.typing import ArrayLike as _ArrayLike
import typing
from typing import Optional as _Optional, Union as _Union
__all__: list[str] = ['SCENARIOS', 'Answer', 'Camera', 'Detections', 'Detector', 'Error', 'Filter', 'Frame', 'Label', 'Live', 'Motion', 'Reason', 'Result', 'Scenario', 'Scorer', 'Simulation', 'Truth', 'Verdict', '__version__', 'compare', 'detectors', 'generate', 'kinematics', 'merge', 'replay', 'run', 'score', 'simulate', 'suite', 'tune', 'world', 'worlds']
class Error(Exception):
    """
    An error as the program lcs prints it: the problem, its place, the remedy.
    """
class Verdict(enum.IntEnum):
    """
    The verdict on a corner.
    """
    IGNORED = ...
    NORMAL = ...
    PENDING = ...
    REBEL = ...
class Reason(enum.IntEnum):
    """
    Which of the filter's rules settled a corner's verdict (filter/types/reason.h).
    """
    ALPHA_BEND = ...
    ALPHA_FIRST = ...
    ALPHA_ON_FIELD = ...
    ALPHA_SECOND = ...
    ALPHA_TAKEN = ...
    ALPHA_THIRD = ...
    COMER = ...
    FIRST_SIGHTING = ...
    GOER = ...
    INHERITED = ...
    IN_PSI = ...
    NORMAL_EDGE = ...
    NORMAL_NEIGHBOURS = ...
    NOT_FINITE = ...
    NO_TIME = ...
    OUTBID = ...
    OUTSIDE = ...
    REBEL_EDGE = ...
    REBEL_NEIGHBOURS = ...
    TOO_MANY = ...
    UNKNOWN = ...
    XI_1 = ...
    XI_2 = ...
    XI_3 = ...
    XI_4 = ...
    XI_5 = ...
class Label(enum.IntEnum):
    """
    The truth of a corner (tools/scoring/SCORING.md).
    """
    FIXED = ...
    INDISTINCT = ...
    NONE = ...
    REBEL = ...
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
    def matrix(self) -> numpy.typing.NDArray[numpy.float64]:
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
class Scenario:
    """
    A scenario to simulate, or a recording: a YAML file of the form in scenarios/README.md.
    """
    @staticmethod
    def from_yaml(text: str, *, file: str | os.PathLike[str] = ..., set: collections.abc.Mapping[str, typing.Any] | None = None, seed: int | None = None) -> Scenario:
        """
        A scenario from YAML text. file: a path that gives the name, and the folder from which relative paths
        begin; it need not exist.
        """
    def __init__(self, file: str | os.PathLike[str], *, set: collections.abc.Mapping[str, typing.Any] | None = None, seed: int | None = None) -> None:
        """
        Reads and checks the whole file.

        set: values that replace the file's, as in lcs run --set: {"ego.speed": "0.7 m/s"}.
        seed: replaces the file's.
        Raises Error with file, line, problem and remedy. Warns of settings of the filter that have no
        effect.
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
        Number of frames; for a recording an upper bound.
        """
    @property
    def groups(self) -> list[str]:
        """
        Groups of the scenario, such as "short".
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
        Whether the frames come from a recording instead of a simulation.
        """
    @property
    def seed(self) -> int:
        ...
class Motion:
    """
    How the camera moved from the last frame to this one. Camera frame: x right, y down, z
    forward.
    """
    @staticmethod
    def between(T_WC_before: numpy.typing.ArrayLike, T_WC_now: numpy.typing.ArrayLike, dt: float) -> Motion:
        """
        Of two poses of the camera, 4 x 4, that are dt seconds apart.
        """
    def __init__(self, *, dt: float, rotation: numpy.typing.ArrayLike | None = None, velocity: numpy.typing.ArrayLike | None = None, angular_velocity: numpy.typing.ArrayLike | None = None, up: numpy.typing.ArrayLike | None = None, height: float | None = None, unseen_turn: float = 0.0, velocity_sigma: float = 0.0) -> None:
        """
        dt in s; rotation 3 x 3, none where not given; velocity 3, m/s, of the camera in its frame of now;
        angular_velocity 3, rad/s, from the rotation where not given; up and height: the ground, see
        there; unseen_turn in rad, velocity_sigma in m/s.
        """
    def __repr__(self) -> str:
        ...
    @property
    def angular_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        3 float64, rad/s: mean body rate of the camera.
        """
    @property
    def displacement(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        3 float64, m: of the camera since the last frame, in its frame of now.
        """
    @property
    def dt(self) -> float:
        """
        Time since the last frame, s; 0 in the first one.
        """
    @property
    def height(self) -> float | None:
        """
        m: of the camera above the ground; None if unknown.
        """
    @property
    def rotation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        3 x 3 float64: takes camera coordinates from the last frame to this one.
        """
    @property
    def unseen_turn(self) -> float:
        """
        rad: standard deviation of the rotation's error while gyro readings are missing; else 0.
        """
    @property
    def up(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        3 float64: unit normal of the ground, against gravity, in the camera's frame; None if unknown.
        """
    @property
    def usable(self) -> bool:
        """
        Whether a filter can predict from the last frame by it. If not, the filter starts anew.
        False for the first frame.
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        3 float64, m/s: mean velocity of the camera since the last frame, in its frame of now.
        """
    @property
    def velocity_sigma(self) -> float:
        """
        m/s: standard deviation of the velocity's error; 0 if unknown.
        """
class Truth:
    """
    The truth of a frame, as tools/scoring/SCORING.md defines it. A recorded frame has only labels;
    its motion, depth, object_ids and poses raise ValueError.
    """
    def of(self, points: numpy.typing.ArrayLike) -> numpy.ndarray:
        """
        The rows of `corners` for other points, N x 2 in pixels, such as corners of your own detector.
        """
    @property
    def T_WC(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        4 x 4 float64: takes camera coordinates to the world's (z up), m.
        """
    @property
    def T_WO(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        K x 4 x 4 float64: takes coordinates of the object with that id to the world's; 0 is the world.
        """
    @property
    def boxes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        M x 4 float64: left, top, right, bottom of `objects`, pixel edges.
        """
    @property
    def corners(self) -> numpy.ndarray:
        """
        A row for each of the frame's corners: label, radial, outline, object (its id; 0: the fixed world,
        -1: none), depth_m, motion_x, motion_y (px until the next frame), static_motion_x,
        static_motion_y (px: the same if the point were fixed).
        """
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        H x W float32: z-depth, m; inf where there is sky.
        """
    @property
    def labels(self) -> numpy.typing.NDArray[numpy.uint8]:
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
        The names of all objects by id.
        """
    @property
    def object_ids(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        H x W int32: id of the object that a pixel shows; 0 the fixed setting, -1 sky and the rover.
        """
    @property
    def objects(self) -> numpy.ndarray:
        """
        A row for each visible object: object (its id), left, top, right, bottom (pixel edges of its
        visible part), visible_px, visible_fraction, moving.
        """
class Frame:
    """
    The data of the sensors, and apart from them the truth. Arrays are read-only and keep their values
    when the simulation continues; arrays of pictures are views.
    """
    def __repr__(self) -> str:
        ...
    @property
    def corners(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        N x 2 float64, x and y in pixels: the corners that FAST found.
        """
    @property
    def grey(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        H x W uint8: the grey picture in which the corners were found.
        """
    @property
    def imu(self) -> numpy.ndarray:
        """
        Readings since the last frame, fields t (s), gyro (3, rad/s), accel (3, m/s^2), in the
        IMU's frame; empty for a recorded frame.
        """
    @property
    def index(self) -> int:
        """
        From 0.
        """
    @property
    def motion(self) -> Motion:
        """
        Motion since the last frame as detectors get it: by IMU and odometry with their errors, or as the
        scenario's ego_motion says.
        """
    @property
    def noise(self) -> float | None:
        """
        Standard deviation of the noise of grey, in grey levels; None if all flat parts are black or white.
        """
    @property
    def odometry(self) -> numpy.ndarray:
        """
        Readings since the last frame, fields t (s), velocity (3, m/s, of the rover in its frame: x forward,
        z up), yaw_rate (rad/s, by the wheels; nan if they do not measure it).
        """
    @property
    def picture(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        H x W x 3 uint8, blue, green, red, as OpenCV has it; picture[..., ::-1] is RGB.
        """
    @property
    def signatures(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        N x 32 uint8: the appearance of each corner, by the bits of ORB.
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
        The truth of the frame; detectors must not use it.
        """
class Simulation:
    """
    The frames of a scenario, one after another. To be used by the thread that made it; other
    threads run meanwhile. The same scenario and seed give the same bits.
    """
    def __init__(self, scenario: Scenario) -> None:
        ...
    def __iter__(self) -> collections.abc.Iterator[Frame]:
        ...
    def __next__(self) -> Frame:
        ...
    @property
    def scenario(self) -> Scenario:
        ...
    @property
    def warnings(self) -> list[str]:
        """
        Problems so far, a line each: the rover or an actor ran into something, fell, or tipped over.
        """
class Result:
    """
    The answer of a detector to a frame. Structured arrays have the fields of layers.jsonl; places are in
    pixels, angles in rad, speeds in px/s.
    """
    @property
    def boxes(self) -> numpy.typing.NDArray[numpy.float64]:
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
        Tracked corners, the normal ones first: id, rebel, x, y, trust, age, speed, angle, corner (index of
        its corner, -1: none), circle (index among the circles of its kind, -1: none), ...
        """
    @property
    def ignored(self) -> numpy.ndarray:
        """
        Regions psi, whose corners were ignored: shape (1: circle, 2: rectangle), x, y, size_x, size_y.
        """
    @property
    def log_odds(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        N float32: log odds that each corner moves by itself; empty with the presets lab and cars.
        """
    @property
    def outlines(self) -> list[numpy.typing.NDArray[numpy.float64]]:
        """
        For each square K x 2 float64: x, y of the convex hull of its edges, clockwise in the picture;
        empty with the presets lab and cars.
        """
    @property
    def reasons(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        N uint8, a Reason for each verdict.
        """
    @property
    def rebels(self) -> numpy.typing.NDArray[numpy.bool_]:
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
    def verdicts(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        N uint8, a Verdict for each corner.
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
    def __init__(self, camera: Camera, preset: str = 'default', *, set: collections.abc.Mapping[str, typing.Any] | None = None) -> None:
        """
        preset: default, lab or cars. set: parameters that replace the preset's, by the keys of
        filter/parameters.cpp: {"circle.gap": 0.3}; angles in degrees.
        Raises Error for an unknown preset, key or value, ValueError for an impossible camera.
        """
    def explain(self, corner: int) -> typing.Any:
        """
        The numbers behind the verdict on a corner of the last frame, by its index: track, age,
        assigned (the track that it was assigned to, 0: none), numbers (of MODEL.md, by name and unit) and
        neighbours (corner, k and tanh(m/2) each). None for a corner that the filter has left out, or the frame lacks.
        Raises ValueError with the presets lab and cars.
        """
    def step(self, corners: numpy.typing.ArrayLike, motion: Motion, signatures: numpy.typing.ArrayLike | None = None, *, picture: numpy.typing.ArrayLike | None = None) -> Result:
        """
        Processes the next frame.

        corners: N x 2, x and y in pixels; motion: since the last frame; signatures: N x 32 uint8;
        picture: height x width uint8, grey, without distortion. Bodies that approach at constant speed are
        found only with pictures, and only by the preset default.
        Raises TypeError or ValueError for arrays of another type or shape, and then ignores the frame.
        Numbers that are not finite or out of range never raise: they are left out, see diagnostics.
        """
    @property
    def diagnostics(self) -> list[str]:
        """
        Problems of the data so far, a line for each kind.
        """
class Live:
    """
    Frames from outside, as of a robot: the corners, signatures and motions that a replay of its
    recording has. Times are ns of one clock, and increase for each sensor.
    """
    def __init__(self, settings: str | os.PathLike[str]) -> None:
        """
        settings: lcs.json of a generated sequence, with camera, sensors, and the state at the first
        frame. Raises Error with file, key and remedy.
        """
    def add_imu(self, time_ns: int, gyro: numpy.typing.ArrayLike, accel: numpy.typing.ArrayLike) -> None:
        """
        A reading, 3 numbers each, rad/s and m/s^2, in the IMU's frame. Raises ValueError if the time
        goes back.
        """
    def add_odometry(self, time_ns: int, velocity: numpy.typing.ArrayLike, yaw_rate: float | None = None) -> None:
        """
        A reading of the wheels, as in Frame.odometry; likewise.
        """
    def frame(self, time_ns: int, picture: numpy.typing.ArrayLike) -> Frame:
        """
        The next Frame, by the readings up to its time that were added; later ones wait.

        picture: H x W x 3 uint8, blue, green, red, as the camera gave it. Raises ValueError for another size
        and if the time goes back, and then ignores the picture.
        """
    def is_due(self, time_ns: int) -> bool:
        """
        Whether each sensor of the settings has had a reading at this time or later, so that no earlier
        one will come.
        """
    @property
    def diagnostics(self) -> list[str]:
        """
        Problems of the readings so far, a line for each kind.
        """
    @property
    def scenario(self) -> Scenario:
        """
        For Filter and Detector.
        """
class Detections:
    """
    The answer of your own detector to a frame.
    """
    def __init__(self, rebels: numpy.typing.ArrayLike | None = None, *, boxes: numpy.typing.ArrayLike | None = None, ids: numpy.typing.ArrayLike | None = None, circles: numpy.typing.ArrayLike | None = None, masks: numpy.typing.ArrayLike | None = None) -> None:
        """
        rebels: N bool, True for corners of the frame that move by themselves; None: no verdicts.
        boxes: M x 4, left, top, right, bottom, pixel edges: a box over columns l to r-1 has left l and
        right r. ids: M whole numbers from 0, which stay with their objects from frame to frame.
        masks: in place of boxes, M x H x W bool: the pixels of each object.
        circles: K x 3, x, y, radius in pixels: groups of rebels, by which false objects are counted.
        Raises TypeError or ValueError for arrays of another type or shape. Scorer.add checks places and the
        size of masks against the camera.
        """
class Scorer:
    """
    Scores a run's frames, one after another, without keeping their pictures.
    """
    def __init__(self) -> None:
        ...
    def add(self, frame: Frame, said: Result | Detections | numpy.typing.ArrayLike) -> None:
        """
        said: a Result of the filter or of a Detector, Detections, or N bool, True for rebels among the
        frame's corners. Give the frames in order, from the first on, each once. A call that raises adds
        nothing. Raises ValueError for places outside of the picture (tools/recording/DETECTIONS.md).
        """
    def metrics(self) -> dict[str, typing.Any]:
        """
        All figures of metrics.json (tools/scoring/SCORING.md) by name; None where undefined. Times and sizes
        are known for the filter only.
        """
    @property
    def warnings(self) -> list[str]:
        """
        Problems of the run so far, a line each, as lcs run prints them.
        """
class Detector:
    """
    A detector of the bench: lcs, lcs:lab, lcs:cars, klt, dis (tools/comparators/README.md), or a
    program of yours (tools/comparators/PROTOCOL.md). It says the same as by lcs run.
    """
    def __init__(self, scenario: Scenario, name: str = '', *, command: str = '', timeout: float = 30.0) -> None:
        """
        name: of the detector; lcs if not given. With command: its name in results.
        command: starts the program, as 'python3 mine.py'. timeout: for each of its answers, s.
        Raises ValueError for an unknown name, Error for a program that does not start.
        """
    def finish(self) -> list[str]:
        """
        Ends the program after the last frame. Returns remarks, a line each.
        """
    def step(self, frame: Frame) -> Result:
        """
        Processes the next frame of a scenario with the same camera; give all frames in order.
        Raises Error for a program that ends or answers wrongly.
        """
    @property
    def name(self) -> str:
        ...
class Answer(dict[str, typing.Any]):
    """
    A dict, the result of a command. Jupyter shows its texts and values, and tables to unfold.
    """
def compare(before: str | os.PathLike[str], after: str | os.PathLike[str], *, metric: str = '', markdown: str = '', pictures_at: str = '', allow_missing: bool = False) -> Answer:
    """
    The differences of two suites, beyond the noise of their seeds (tools/suite/README.md).

    before, after: folders, or their suite.json. metric: a regular expression.
    markdown: a folder for a summary in Markdown, whose pictures will be at the address pictures_at.
    allow_missing: judge also if runs of before are missing in after.
    Returns a dict: verdict, a line; finding (regressed, not judged, no regression found, equal);
    regressed; means and scenarios: a dict for each figure, with group
    or scenario, metric, before, after, change, half (of its 95 % interval; None where unknown), pairs,
    verdict (improved, regressed, moved, unknown, or none); incomparable; text: as the program prints it.
    Raises Error for suites that cannot be read, or have nothing in common.
    """
def detectors() -> dict[str, typing.Any]:
    """
    The names of the bench's detectors, with a line about each.
    """
def generate(paths: str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]] | None = None, *, suite: bool = False, worlds: str = '', count: int = 60, family: str = '', out: str = '', formats: list[str] = [], add: bool = False, frames: int = 0, seed: int | None = None, set: collections.abc.Mapping[str, typing.Any] | None = None, jobs: int = 1, shard: str = '', group: str | None = None, filter: str = '', seeds: int = 1, progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
    """
    Writes a scenario as a sequence that other tools read (tools/sequence/README.md).

    paths: the scenario's file; with suite=True files and folders. worlds: in its place a split of
    worlds, as in suite. formats: names; if not given, all but kitti and mcap. add: adds them to
    the finished sequence in out. frames: only the first so many.
    Returns a dict: folders; errors, of many; frames (first, last + 1) and notes, of one; messages. The
    same call goes on after it was interrupted.
    """
def kinematics(config: str = '', *, set: collections.abc.Mapping[str, typing.Any] | None = None, out: str | os.PathLike[str] = 'out/kinematics', tolerance: float = 1.0, quick: bool = False, progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
    """
    Measures when the motion model holds for a camera and rover (tools/kinematics/README.md).

    config: a scenario's file; crossing.yaml if not given. tolerance: of a prediction, px.
    Returns a dict: folder; answer: for each topic a dict of text, figures (name, value, unit, expected,
    NaN without theory) and verdict; text: as the program prints it.
    """
def merge(parts: str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]], *, out: str | os.PathLike[str] = 'out/suite', baseline: str = '', allow_missing: bool = False) -> Answer:
    """
    Joins the folders of the parts of a suite (shard). Returns as suite.
    """
def replay(path: str | os.PathLike[str], *, recording: collections.abc.Mapping[str, typing.Any] | None = None, ego_motion: str = '', corners: str = '', fast_threshold: str = '', detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, preset: str = '', set: collections.abc.Mapping[str, typing.Any] | None = None, beside: list[str] = [], out: str = '', video: bool = False, events: bool = False, threads: int = 1, progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
    """
    Runs a detector on a recording (tools/replay/README.md), and writes the folder of lcs replay.

    path: a folder, video or ROS bag. recording: keys of a scenario's recording, as {"focal": 600,
    "topics.imu": "/imu"}; lists as text, "319.5,239.5". ego_motion: imu or truth. corners:
    pictures or events. fast_threshold: contrast of a corner, 1 to 254 grey levels, or auto. Returns as run.
    """
def run(scenario: str | os.PathLike[str], *, out: str = '', seed: int | None = None, frames: str = '', set: collections.abc.Mapping[str, typing.Any] | None = None, detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, beside: list[str] = [], recorded: str = '', detections: str = '', video: bool = False, events: bool = False, keep: str = 'all', gzip: bool = False, report: bool = False, threads: int = 1, progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
    """
    Runs a scenario's file and writes the folder of lcs run, out/SCENARIO if not given.

    beside: "DETECTOR=FOLDER" each. The other arguments are as in suite.
    Returns a dict: scenario, seed, detectors (by name a dict of metrics, criteria, folder), messages.
    """
def score(said: _Union[str, _PathLike[str], _Iterable[tuple[Frame, _Union[Result, Detections, _ArrayLike]]]], *, detections: _Union[str, _PathLike[str]] = '') -> dict[str, _Optional[float]]:
    """
    The figures of metrics.json, by name; None where undefined.

        said: pairs of a Frame and the answer to it: a Result, Detections, or N bool, True for rebels among
        frame.corners. Give all frames of one run in order. Or the folder of a stored run; detections is
        then a CSV file of another detector (tools/recording/DETECTIONS.md).

    """
def simulate(scenario: Scenario) -> Simulation:
    """
    The frames of a Scenario, simulated or recorded, one after another.

        Raises Error for a scenario that cannot be simulated: at once, or in the frame in which the physics
        fail.

    """
def suite(paths: str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]] | None = None, *, group: str | None = None, filter: str = '', jobs: int = 0, worlds: str = '', count: int = 60, family: str = '', seeds: int | None = None, detector: str = '', detector_command: str = '', detector_timeout: float = 30.0, recorded: str = '', detections: str = '', beside: list[str] = [], set: collections.abc.Mapping[str, typing.Any] | None = None, keep: str = 'all', shard: str = '', times: str = '', out: str | os.PathLike[str] = 'out/suite', baseline: str = '', allow_missing: bool = False, all: bool = False, anew: bool = False, progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
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
def tune(suites: str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]], *, validate: str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]] | None = None, keys: list[str] = [], set: collections.abc.Mapping[str, typing.Any] | None = None, evaluations: int = 300, seed: int = 1, out: str | os.PathLike[str] = 'out/tune', progress: collections.abc.Callable[[int, int], typing.Any] | None = None) -> Answer:
    """
    Learns the filter's parameters from suites of the split train, as lcs tune.

    suites, validate: folders. keys: of the parameters; all learnt ones if not given.
    Returns a dict: folder; before, after: values by key; stated: for each kind of suites a dict of suite
    and, before and after, objective, f1, false objects and corners a frame; evaluations; record, a text.
    The same call goes on after it was interrupted.
    """
def world(family: str, seed: int = 1, *, out: str = '', pictures: str = '', sheet: bool = False) -> Answer:
    """
    Draws a scenario and its scene from a seed, and writes them (scenes/worlds/README.md).

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
