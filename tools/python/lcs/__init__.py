"""Test bench for the Line-Circle-Square filter: sequences with their truth, the filter, comparators, scores, suites.

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

from collections.abc import Iterable as _Iterable
from os import PathLike as _PathLike
from pathlib import Path as _Path
from typing import Optional as _Optional, Union as _Union

from numpy.typing import ArrayLike as _ArrayLike

from . import _core
from ._core import *
from ._core import __version__

__all__ = ["SCENARIOS"] + sorted(
    ["Answer", "__version__", "score", "simulate"] + [name for name in vars(_core) if name[0] != "_"]
)

# The program runs suites in processes of its own, and knows where the scenes are.
_core._use_program(_Path(__file__).parent / "bin" / "lcs")

#: Folder of the project's own scenarios, as `lcs.SCENARIOS / "suite" / "night.yaml"`.
SCENARIOS: _Path = _Path(_core._shipped_folder("scenarios"))


class Answer(dict):
    """A dict, the result of a command. Jupyter shows its texts and values, and tables to unfold."""

    def _repr_html_(self) -> str:
        from ._page import html_of

        return "".join(html_of(name, value) for name, value in self.items())


def simulate(scenario: Scenario) -> Simulation:
    """The frames of a Scenario, simulated or recorded, one after another.

    Raises Error for a scenario that cannot be simulated: at once, or in the frame in which the physics
    fail.
    """
    return Simulation(scenario)


def score(
    said: _Union[
        str, _PathLike[str], _Iterable[tuple[Frame, _Union[Result, Detections, _ArrayLike]]]
    ],
    *,
    detections: _Union[str, _PathLike[str]] = "",
) -> dict[str, _Optional[float]]:
    """The figures of metrics.json, by name; None where undefined.

    said: pairs of a Frame and the answer to it: a Result, Detections, or N bool, True for rebels among
    frame.corners. Give all frames of one run in order. Or the folder of a stored run; detections is
    then a CSV file of another detector (tools/recording/DETECTIONS.md).
    """
    if isinstance(said, (str, _PathLike)):
        return _core._score_files(said, detections)
    scorer = Scorer()
    for frame, detected in said:
        scorer.add(frame, detected)
    return scorer.metrics()
