#!/usr/bin/env python3
"""Compares simulated sequences with recordings by image statistics: are the worlds like the world?

    PYTHONPATH=build/python python3 tests/worlds/likeness.py worlds=out/worlds suite=scenarios/suite street=street.yaml

Each NAME=PATH is a group of runs: a scenario file, simulated or recorded (scenarios/README.md), or a folder, of
which all scenario files are taken. Some pairs of neighbouring pictures of each run are measured, spread evenly.
The table has for each group the median over its pairs and, in brackets, the range of 80 in 100 pairs; a star marks
a median outside of that range of the first group. A CSV file has one row for each pair.

Needs python3-opencv and python3-numpy.
"""
import argparse
import csv
import sys
from pathlib import Path

import lcs  # before cv2, whose OpenGL would take the place of the software renderer's

import cv2
import numpy as np

MEASURES = {  # measures of corners are medians over the corners of a picture
    "corners": "FAST corners in a picture, by the scenario's corners.threshold",
    "corners_per_mpx": "the same for a million pixels",
    "spacing_px": "distance from a corner to the nearest other one",
    "contrast": "FAST score: the highest threshold, in grey levels, at which a corner is still found",
    "motion_px": "length of the motion to the next picture, by optical flow",
    "direction_deg": "mean direction of the corners that move: 0 to the right, 90 down",
    "one_way": "how much they move in the same direction: 1 all, 0 evenly to all sides",
    "outward": "how much they move away from the centre of the picture: 1 all, -1 all towards it",
    "noise": "standard deviation of the noise, grey levels, where the picture is flat",
    "followed": "share of corners that optical flow follows to the next picture and back",
    "found_again": "share of these with a corner of the next picture within 2 px",
    "by_chance": "the same share for places 8 to 16 px beside",
}
MOVES_PX = 0.5  # corners that move less have no direction
FEWEST = 5  # corners that a measure needs
FOUND_PX = 2
MARGIN_PX = 3  # FAST finds no corner nearer to a side of the picture
RING = [(0, -3), (1, -3), (2, -2), (3, -1), (3, 0), (3, 1), (2, 2), (1, 3),
        (0, 3), (-1, 3), (-2, 2), (-3, 1), (-3, 0), (-3, -1), (-2, -2), (-1, -3)]  # fmt: skip


def distances(places, corners, rank):
    """From each place to its nearest corner (rank 0), or to the second nearest (rank 1)."""
    if len(places) == 0 or len(corners) <= rank:
        return np.full(len(places), np.inf)
    matches = cv2.BFMatcher().knnMatch(places.astype(np.float32), corners, rank + 1)
    return np.array([match[rank].distance for match in matches])


def scores(grey, corners):
    """FAST's: the largest threshold that nine neighbours on the ring all exceed, to one side."""
    x, y = corners.astype(int).T
    ring = np.array([grey[y + dy, x + dx] for dx, dy in RING + RING[:8]]).astype(int) - grey[y, x]
    arcs = np.lib.stride_tricks.sliding_window_view(ring, 9, axis=0)
    return np.maximum(arcs.min(-1), -arcs.max(-1)).max(0) - 1


def follow(before, after, corners):
    """Where the corners are in `after`, and whether the way back ends where it began."""
    settings = {"winSize": (15, 15), "maxLevel": 4, "criteria": (3, 30, 0.01), "minEigThreshold": 1e-4,
                "flags": cv2.OPTFLOW_USE_INITIAL_FLOW}  # fmt: skip
    ends, there, _ = cv2.calcOpticalFlowPyrLK(before, after, corners, corners.copy(), **settings)
    again, back, _ = cv2.calcOpticalFlowPyrLK(after, before, ends, ends.copy(), **settings)
    returns = np.linalg.norm(again - corners, axis=1) <= MOVES_PX
    return ends, returns & (there[:, 0] == 1) & (back[:, 0] == 1)


def measure(now, then):
    """The measures of two neighbouring frames; those that need more corners are left out."""
    corners, next_corners = now.corners.astype(np.float32), then.corners.astype(np.float32)
    size = np.array(now.grey.shape[::-1])
    values = {"corners": len(corners), "corners_per_mpx": 1e6 * len(corners) / now.grey.size, "noise": now.noise}
    if len(corners) < FEWEST:
        return values
    values["spacing_px"] = np.median(distances(corners, corners, 1))
    values["contrast"] = np.median(scores(now.grey, now.corners))
    ends, followed = follow(now.grey, then.grey, corners)
    values["followed"] = followed.mean()
    starts, ends = corners[followed], ends[followed]
    if len(starts) < FEWEST:
        return values
    motion, lengths = ends - starts, np.linalg.norm(ends - starts, axis=1)
    values["motion_px"] = np.median(lengths)

    moving = lengths >= MOVES_PX
    if moving.sum() >= FEWEST:
        ways = motion[moving] / lengths[moving, None]
        out = starts[moving] - (size - 1) / 2
        mean = ways.mean(axis=0)
        values["direction_deg"] = np.degrees(np.arctan2(mean[1], mean[0]))
        values["one_way"] = np.linalg.norm(mean)
        values["outward"] = (ways * out / np.linalg.norm(out, axis=1).clip(1e-9)[:, None]).sum(axis=1).mean()

    random = np.random.default_rng(1)
    angles, aside = random.uniform(0, 2 * np.pi, len(ends)), random.uniform(8, 16, len(ends))
    beside = ends + aside[:, None] * np.c_[np.cos(angles), np.sin(angles)]
    for name, places in ("found_again", ends), ("by_chance", beside):
        inside = ((places >= MARGIN_PX) & (places <= size - 1 - MARGIN_PX)).all(axis=1)
        if inside.any():
            values[name] = (distances(places[inside], next_corners, 0) <= FOUND_PX).mean()
    return values


def firsts(frames, pairs):
    """The first frames of so many pairs, spread evenly; fewer in a short run."""
    last = frames - 2
    return {int(np.floor(share * last + 0.5)) for share in (np.linspace(0, 1, pairs) if pairs > 1 else [0.5]) if last >= 0}


def rows_of(group, file, pairs):
    scenario = lcs.Scenario(file)
    wanted = firsts(scenario.frames, pairs)
    rows, before = [], None
    for frame in lcs.simulate(scenario):
        if before and before.index in wanted and frame.index == before.index + 1:
            rows.append({"group": group, "run": scenario.name, "frame": before.index, **measure(before, frame)})
        if frame.index > max(wanted, default=-1):
            break
        before = frame
    if not rows:
        raise ValueError(f"{file} has no two neighbouring pictures; give a longer run")
    return rows


def table_of(rows):
    """A line for each measure, a column for each group."""
    groups = list(dict.fromkeys(row["group"] for row in rows))
    lines = [["", *groups]]
    for name in MEASURES:
        line, low, high = [name], -np.inf, np.inf
        for group in groups:
            values = [row[name] for row in rows if row["group"] == group and row.get(name) is not None]
            if not values:
                line.append("-")
                continue
            least, median, most = np.quantile(values, [0.1, 0.5, 0.9])
            if group == groups[0]:
                low, high = least, most
            line.append(f"{'' if low <= median <= high else '*'}{median:.3g} ({least:.3g} to {most:.3g})")
        lines.append(line)
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines)


def files_of(text):
    name, equals, path = text.partition("=")
    if not name or not equals or "," in name:
        raise ValueError(f"'{text}' is no group; give NAME=PATH, as worlds=out/worlds")
    files = sorted(Path(path).rglob("*.yaml")) if Path(path).is_dir() else [Path(path)]
    if not files:
        raise ValueError(f"{path} has no scenario files; give a folder with *.yaml, or a file")
    return [(name, file) for file in files]


def main(arguments=None):
    parser = argparse.ArgumentParser(
        formatter_class=argparse.RawDescriptionHelpFormatter, description=__doc__,
        epilog="measures:\n" + "\n".join(f"  {name:16} {about}" for name, about in MEASURES.items()))  # fmt: skip
    parser.add_argument("groups", nargs="+", metavar="NAME=PATH")
    parser.add_argument("--pairs", type=int, default=12, metavar="N", help="pairs of each run; 12 if not given")
    parser.add_argument("--out", type=Path, default=Path("likeness.csv"), metavar="FILE", help="likeness.csv if not given")
    options = parser.parse_args(arguments)
    if options.pairs < 1:
        parser.error(f"--pairs {options.pairs}: give 1 or more")
    try:
        if options.out.exists():
            raise ValueError(f"{options.out} exists; remove it, or give another --out")
        runs = [run for text in options.groups for run in files_of(text)]
        rows = [row for name, file in runs for row in rows_of(name, file, options.pairs)]
        part = options.out.with_name(options.out.name + ".part")
        with part.open("w", newline="") as file:
            writer = csv.DictWriter(file, ["group", "run", "frame", *MEASURES], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        part.replace(options.out)
    except (lcs.Error, OSError, ValueError) as error:
        print(f"likeness: {error}", file=sys.stderr)
        return 2
    print(table_of(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
