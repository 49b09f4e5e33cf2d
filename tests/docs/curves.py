#!/usr/bin/env python3
"""Draws how detectors depend on distance, speed, turning, corners and told motion.

    lcs suite --worlds test --count 70 --beside klt --keep all --out out/worlds
    lcs suite scenarios/sweeps/turning.yaml scenarios/sweeps/told_motion.yaml --beside klt --out out/sweeps
    python3 tests/docs/curves.py out/curves.png out/worlds out/sweeps

Needs python3-matplotlib. Corners of all worlds count together, after each run's warm-up, as SCORING.md has
them: precision by true and false rebels, recall by those that it counts.
"""
import gzip
import json
import pathlib
import sys

import matplotlib
import numpy as np

matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402

WARM_UP = 3  # frames
LEAST = 200  # rebel corners in a bin that is drawn
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]  # Okabe and Ito
MARKS = "osD^vPX"


def frames_of(path):
    with gzip.open(path, "rt") as file:
        return [frame for frame in map(json.loads, file) if "corners" in frame]


def numbers(values):
    """null is an infinite depth, or the motion of a point behind the camera."""
    return np.array([np.nan if value is None else value for value in values], float)


def corners_of(run, said_by):
    """Rows of a run: moves, said, counted by recall, log odds, depth (m), speed across (m/s), corners."""
    focal_px = json.loads((run / "camera.json").read_text())["focal_px"]
    layers, first, rows = frames_of(said_by / "layers.jsonl.gz"), {}, []
    for k, (said, truth) in enumerate(zip(layers, frames_of(run / "truth.jsonl.gz"))):
        corners, labels = truth["corners"], np.array(truth["corners"]["label"])
        moves, objects = labels == "rebel", np.array(corners["object"])
        for object in set(objects[moves].tolist()):
            first.setdefault(object, k)
        if k < WARM_UP or not len(labels):
            continue
        depth = numbers(corners["depth_m"])
        own_px = np.hypot(*(numbers(corners[f"motion_{a}"]) - numbers(corners[f"static_motion_{a}"]) for a in "xy"))
        since_s = said["told_motion"]["dt_s"] or np.nan  # null in frames without a usable motion
        rows.append(np.c_[
            moves, np.array(said["corners"]["verdict"]) == "rebel",
            ~moves | (np.array([first.get(object, k) for object in objects]) + WARM_UP <= k),
            said.get("log_odds", np.full(len(labels), np.nan)), depth, own_px * depth / focal_px / since_s,
            np.full(len(labels), len(labels))][moves | (labels == "fixed")])
    return np.concatenate(rows) if rows else np.empty((0, 7))


def f1(rows):
    moves, said, counted = rows[:, :3].T.astype(bool)
    precision = (moves & said).sum() / max(1, said.sum())
    recall = (moves & said & counted).sum() / max(1, (moves & counted).sum())
    return 2 * precision * recall / max(1e-9, precision + recall), precision, recall


def draw_bins(axes, detectors, column, edges, title, unit, measure=0):
    for (name, rows), colour, mark in zip(detectors.items(), COLOURS, MARKS):
        places = np.digitize(rows[:, column], edges)
        drawn = [(np.sqrt(edges[b - 1] * edges[b]), f1(rows[places == b])[measure]) for b in range(1, len(edges))
                 if rows[places == b, 0].sum() >= LEAST]
        if drawn:
            axes.plot(*zip(*drawn), color=colour, marker=mark, label=name)
    axes.set(title=title, xlabel=unit, xscale="log", ylim=(0, 1), ylabel=["F1", "precision", "recall"][measure])
    axes.set_xticks(edges[::2], [f"{edge:.0f}" if edge >= 10 else f"{edge:.2g}" for edge in edges[::2]])
    axes.minorticks_off()


def draw_curve(axes, detectors):
    for (name, rows), colour, mark in zip(detectors.items(), COLOURS, MARKS):
        _, precision, recall = f1(rows)
        axes.plot(recall, precision, color=colour, marker=mark, linestyle="none", label=name)
        if np.isnan(rows[:, 3]).all():
            continue  # no log odds
        counted = rows[rows[:, 2] > 0]
        moves = counted[np.argsort(-counted[:, 3], kind="stable"), 0]
        right = np.cumsum(moves)
        axes.plot(right / right[-1], right / np.arange(1, len(moves) + 1), color=colour)
    axes.set(title="corners of all worlds", xlabel="recall", ylabel="precision", xlim=(0, 1), ylim=(0, 1))


def draw_sweep(axes, folder, name, title, unit):
    suites = [folder / "suite.json", *sorted(folder.glob("beside/*/suite.json"))]
    for path, colour, mark in zip(suites, COLOURS, MARKS):
        suite = json.loads(path.read_text())
        points = [(float(s["point"][0][1].split()[0]), np.mean([run["metrics"]["rebel.f1"] for run in s["runs"]]))
                  for s in suite["scenarios"] if s["name"].startswith(name + "@")]
        if points:
            axes.plot(*zip(*points), color=colour, marker=mark)
    axes.set(title=title, xlabel=unit, ylabel="F1", ylim=(0, 1))


def main():
    picture, worlds, sweeps = map(pathlib.Path, sys.argv[1:])
    runs = sorted(worlds.glob("runs/*/seed*"))
    detectors = {"lcs": worlds, **{path.name: path for path in sorted(worlds.glob("beside/*"))}}
    detectors = {name: np.concatenate([corners_of(run, path / run.relative_to(worlds)) for run in runs])
                 for name, path in detectors.items()}
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.5), layout="constrained")
    draw_curve(axes[0, 0], detectors)
    draw_bins(axes[0, 1], detectors, 4, np.geomspace(1, 32, 11), "distance of the corner", "m")
    draw_bins(axes[0, 2], detectors, 5, np.geomspace(0.1, 3.2, 11), "speed across the line of sight", "m/s", 2)
    draw_bins(axes[1, 0], detectors, 6, np.geomspace(50, 3200, 11), "corners in the frame", "corners")
    draw_sweep(axes[1, 1], sweeps, "turning", "turning rate of the rover", "rad/s")
    draw_sweep(axes[1, 2], sweeps, "told_motion", "wrong scale of the odometry", "share")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    axes[0, 0].legend(loc="lower left")
    figure.savefig(picture, dpi=100)


main()
