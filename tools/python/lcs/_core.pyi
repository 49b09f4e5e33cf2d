"""Types of the compiled part. N is a frame's number of corners."""

from collections.abc import Iterable, Iterator, Mapping
from enum import IntEnum
from os import PathLike
from pathlib import Path
from typing import Any, Optional, Union, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_Settings = Optional[Mapping[str, Union[str, float, bool]]]
_Rows = NDArray[np.void]  # a structured array

def _use_scenes(folder: Union[str, PathLike[str]]) -> None: ...

class Error(Exception): ...

class Verdict(IntEnum):
    IGNORED = 0
    PENDING = 1
    NORMAL = 2
    REBEL = 3

class Label(IntEnum):
    NONE = 0
    FIXED = 1
    INDISTINCT = 2
    REBEL = 3

class Reason(IntEnum):
    UNKNOWN = 0
    NOT_FINITE = 1
    OUTSIDE = 2
    TOO_MANY = 3
    IN_PSI = 4
    NO_TIME = 5
    NORMAL_EDGE = 6
    REBEL_EDGE = 7
    NORMAL_NEIGHBOURS = 8
    REBEL_NEIGHBOURS = 9
    COMER = 10
    GOER = 11
    INHERITED = 12
    FIRST_SIGHTING = 13
    ALPHA_FIRST = 14
    XI_5 = 15
    XI_4 = 16
    OUTBID = 17
    XI_1 = 18
    ALPHA_SECOND = 19
    ALPHA_BEND = 20
    ALPHA_ON_FIELD = 21
    ALPHA_TAKEN = 22
    ALPHA_THIRD = 23
    XI_3 = 24
    XI_2 = 25

@final
class Camera:
    def __init__(
        self, *, focal: float, cx: float, cy: float, width: int, height: int, rate: float = 0.0
    ) -> None: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def rate(self) -> float: ...
    @property
    def matrix(self) -> NDArray[np.float64]: ...

@final
class Scenario:
    def __init__(
        self,
        file: Union[str, PathLike[str]],
        *,
        set: _Settings = None,
        seed: Optional[int] = None,
    ) -> None: ...
    @staticmethod
    def from_yaml(
        text: str,
        *,
        file: Union[str, PathLike[str]] = "scenario.yaml",
        set: _Settings = None,
        seed: Optional[int] = None,
    ) -> Scenario: ...
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> Path: ...
    @property
    def purpose(self) -> str: ...
    @property
    def groups(self) -> list[str]: ...
    @property
    def seed(self) -> int: ...
    @property
    def frames(self) -> int: ...
    @property
    def recorded(self) -> bool: ...
    @property
    def camera(self) -> Camera: ...

@final
class Motion:
    def __init__(
        self,
        *,
        dt: float,
        rotation: Optional[ArrayLike] = None,
        velocity: Optional[ArrayLike] = None,
        angular_velocity: Optional[ArrayLike] = None,
        up: Optional[ArrayLike] = None,
        height: Optional[float] = None,
        unseen_turn: float = 0.0,
        velocity_sigma: float = 0.0,
    ) -> None: ...
    @staticmethod
    def between(T_WC_before: ArrayLike, T_WC_now: ArrayLike, dt: float) -> Motion: ...
    @property
    def dt(self) -> float: ...
    @property
    def rotation(self) -> NDArray[np.float64]: ...
    @property
    def velocity(self) -> NDArray[np.float64]: ...
    @property
    def displacement(self) -> NDArray[np.float64]: ...
    @property
    def angular_velocity(self) -> NDArray[np.float64]: ...
    @property
    def unseen_turn(self) -> float: ...
    @property
    def velocity_sigma(self) -> float: ...
    @property
    def up(self) -> Optional[NDArray[np.float64]]: ...
    @property
    def height(self) -> Optional[float]: ...
    @property
    def usable(self) -> bool: ...

@final
class Truth:
    @property
    def motion(self) -> Motion: ...
    @property
    def labels(self) -> NDArray[np.uint8]: ...
    @property
    def corners(self) -> _Rows: ...
    def of(self, points: ArrayLike) -> _Rows: ...
    @property
    def objects(self) -> _Rows: ...
    @property
    def boxes(self) -> NDArray[np.float64]: ...
    @property
    def names(self) -> dict[int, str]: ...
    @property
    def depth(self) -> NDArray[np.float32]: ...
    @property
    def object_ids(self) -> NDArray[np.int32]: ...
    @property
    def T_WC(self) -> NDArray[np.float64]: ...
    @property
    def T_WO(self) -> NDArray[np.float64]: ...

@final
class Frame:
    @property
    def index(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def time_ns(self) -> int: ...
    @property
    def picture(self) -> NDArray[np.uint8]: ...
    @property
    def grey(self) -> NDArray[np.uint8]: ...
    @property
    def noise(self) -> Optional[float]: ...
    @property
    def corners(self) -> NDArray[np.float64]: ...
    @property
    def signatures(self) -> NDArray[np.uint8]: ...
    @property
    def motion(self) -> Motion: ...
    @property
    def imu(self) -> _Rows: ...
    @property
    def odometry(self) -> _Rows: ...
    @property
    def truth(self) -> Truth: ...

@final
class Simulation(Iterator[Frame]):
    def __init__(self, scenario: Scenario) -> None: ...
    def __iter__(self) -> Simulation: ...
    def __next__(self) -> Frame: ...
    @property
    def scenario(self) -> Scenario: ...
    @property
    def warnings(self) -> list[str]: ...

@final
class Result:
    @property
    def verdicts(self) -> NDArray[np.uint8]: ...
    @property
    def reasons(self) -> NDArray[np.uint8]: ...
    @property
    def rebels(self) -> NDArray[np.bool_]: ...
    @property
    def edges(self) -> _Rows: ...
    @property
    def circles(self) -> _Rows: ...
    @property
    def squares(self) -> _Rows: ...
    @property
    def boxes(self) -> NDArray[np.float64]: ...
    @property
    def outlines(self) -> list[NDArray[np.float64]]: ...
    @property
    def ignored(self) -> _Rows: ...
    @property
    def collectors(self) -> _Rows: ...

@final
class Filter:
    @overload
    def __init__(self, scenario: Scenario) -> None: ...
    @overload
    def __init__(
        self, camera: Camera, preset: str = "default", *, set: _Settings = None
    ) -> None: ...
    def step(
        self,
        corners: ArrayLike,
        motion: Motion,
        signatures: Optional[ArrayLike] = None,
        *,
        picture: Optional[ArrayLike] = None,
    ) -> Result: ...
    @property
    def diagnostics(self) -> list[str]: ...

@final
class Detections:
    def __init__(
        self,
        rebels: Optional[ArrayLike] = None,
        *,
        boxes: Optional[ArrayLike] = None,
        ids: Optional[Iterable[int]] = None,
        circles: Optional[ArrayLike] = None,
        masks: Optional[ArrayLike] = None,
    ) -> None: ...

@final
class Scorer:
    def __init__(self) -> None: ...
    def add(self, frame: Frame, said: Union[Result, Detections, ArrayLike]) -> None: ...
    def metrics(self) -> dict[str, Optional[float]]: ...
    @property
    def warnings(self) -> list[str]: ...
