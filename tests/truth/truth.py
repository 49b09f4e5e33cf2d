#!/usr/bin/env python3
"""Compares what `lcs generate` writes with oracles that share no code with it.

Small scenes of its own (chessboards, bars, boxes) are made into sequences; their pictures, depths, flow,
events and readings of the IMU are compared with projections by OpenCV, rays by MuJoCo, integration, and
closed forms.
"""

import argparse
import importlib
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True  # the modules beside this file leave nothing in the repository

CHECKS = {  # name: module, function, what it tests
    "boards": ("boards", "boards", "corners of chessboards made of boxes, in pictures of five cameras"),
    "texture": ("boards", "texture", "corners of a chessboard that is a texture"),
    "stereo": ("boards", "stereo", "disparities of the corners, in a rig of two cameras"),
    "bars": ("light", "bars", "width and place of dark bars, in linear light"),
    "shutter": ("light", "shutter", "rolling shutter: slope of a pole; exposure: ramp of an outline"),
    "events": ("events", "events", "numbers and times of events of a bar that passes"),
    "imu": ("inertial", "imu", "readings of the IMU, integrated; gravity; the time of a reading"),
    "imu-samples": ("inertial", "imu_samples", "the same with `imu.reading: sample`, if the program has it"),
    "depth": ("geometry", "depth", "depth and masks against MuJoCo's rays, by three lenses"),
    "flow": ("geometry", "flow", "optical flow of still and moving boxes, by three lenses"),
    "masks": ("geometry", "masks", "masks and boxes of COCO, DAVIS and MOT"),
}
SKIPPED = 77  # as CTest takes it


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="checks:\n" + "\n".join(f"  {name:12} {what}" for name, (_, _, what) in CHECKS.items()) + """

Prints a table in Markdown: what was measured, in which range it has to be, and the verdict. The reason
for each range stands beside it in the source. Progress is on stderr. Needs numpy and OpenCV's Python
module (Debian: python3-opencv); takes a minute on one core.

Exit codes: 0 all agree; 1 something disagrees; 2 wrong usage; 77 a Python module is missing.

Examples:
  python3 tests/truth/truth.py --lcs build/lcs
  python3 tests/truth/truth.py --lcs build/lcs --only boards stereo
  python3 tests/truth/truth.py --lcs build/lcs --only events --keep /tmp/events     leaves its files there""",
    )
    parser.add_argument("--lcs", required=True, type=Path, metavar="PROGRAM", help="the program lcs to test")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=CHECKS,
        default=list(CHECKS),
        metavar="NAME",
        help="only these checks (below)",
    )
    parser.add_argument(
        "--keep",
        type=Path,
        metavar="DIR",
        help="make scenes, scenarios and sequences in this new folder, and leave them there",
    )
    found = parser.parse_args()
    if not found.lcs.is_file():
        parser.error(f"--lcs: there is no file {found.lcs}")
    if found.keep and found.keep.exists() and (not found.keep.is_dir() or any(found.keep.iterdir())):
        parser.error(f"--keep: {found.keep} is there, and is no empty folder")
    return found


def rows_of(name, bench):
    """All rows of a check; a run of the program that fails is a row that disagrees."""
    from bench import ProgramFailed, Row

    module, function, _ = CHECKS[name]
    try:
        yield from getattr(importlib.import_module(module), function)(bench)
    except ProgramFailed as failure:
        print(f"truth: {failure}", file=sys.stderr)
        yield Row(
            f"{name}: runs of lcs that failed", 1, (0, 0), unit="", note=str(failure).replace("\n", " ")
        )


def main():
    asked = arguments()
    try:
        import cv2  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as missing:
        print(f"SKIPPED: {sys.executable} lacks the module {missing.name} (Debian: python3-opencv)")
        return SKIPPED
    from bench import Bench

    begin_s = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="lcs-truth-") as temporary:
        bench = Bench(asked.lcs, asked.keep or temporary)
        rows = []
        for name in asked.only:
            rows += rows_of(name, bench)
    print("| row | measured | allowed | verdict |\n|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(row.cells()) + " |")
    wrong = sum(not row.agrees for row in rows)
    print(f"truth: {len(rows)} rows, {wrong} disagree, {time.monotonic() - begin_s:.0f} s", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
