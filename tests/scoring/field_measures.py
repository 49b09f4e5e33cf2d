"""Compares the measures of metrics.json with TrackEval's, pycocotools', scikit-learn's and DAVIS'.

Usage: field_measures.py RUN...

RUN is the folder of a run with layers.jsonl and truth.jsonl. The boxes are chosen here anew, from
tools/scoring/SCORING.md.
"""
import contextlib
import gzip
import io
import json
import pathlib
import sys

import numpy as np
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval
from scipy.optimize import linear_sum_assignment
from sklearn.metrics import precision_recall_curve
from trackeval.metrics import CLEAR, HOTA, Identity, JAndF

WARM_UP = 3  # frames
TOLERANCE = 1e-6


def rows(columns):
    return [dict(zip(columns, values)) for values in zip(*columns.values())]


def lines(path):
    """Of a file that lcs suite has compressed, or lcs run has not."""
    packed = path.with_name(path.name + ".gz")
    with gzip.open(packed, "rt") if packed.exists() else open(path) as file:
        return [json.loads(line) for line in file]


def iou(a, b):
    low, high = np.maximum(a[:2], b[:2]), np.minimum(a[2:], b[2:])
    common = np.prod(np.maximum(high - low, 0))
    return common / (np.prod(a[2:] - a[:2]) + np.prod(b[2:] - b[:2]) - common)


def overlaps(truths, squares):
    return np.array([[iou(a["box"], b["box"]) for b in squares] for a in truths]).reshape(len(truths), len(squares))


class Frame:
    """The boxes that count, and all masks, of a frame."""

    def __init__(self, layers, truth, moved, size):
        self.corners, labels = rows(layers["corners"]), rows(truth["corners"])
        for i, (corner, label) in enumerate(zip(self.corners, labels)):
            corner.update(label=label["label"], object=label["object"], odds=layers["log_odds"][i])
        objects = rows(truth["objects"])
        for o in objects:
            o["box"] = np.array([o[side] for side in ("left", "top", "right", "bottom")], float) - 0.5
        moved |= {o["object"] for o in objects if o["moving"]}
        squares = [s for s in rows(layers["squares"]) if s["rebel_circles"] > 0 or s["circles"] == 0]
        for s in squares:
            half = np.array([s["half_width"], s["half_height"]])
            s["box"] = np.r_[np.array([s["x"], s["y"]]) - half, np.array([s["x"], s["y"]]) + half]
            s["odds"] = self.odds(s["box"])
        self.moving = [o for o in objects if o["moving"]]
        self.all_squares = squares
        self.wanted = [o for o in self.moving if self.is_eligible(o)]
        movers = [o for o in objects if o["object"] in moved]
        match = overlaps(movers, squares)
        match[match < 0.5] = 0
        ignored = {j for i, j in zip(*linear_sum_assignment(-match)) if match[i, j] > 0 and movers[i] not in self.wanted}
        self.squares = [s for j, s in enumerate(squares) if j not in ignored]
        self.size = size

    def is_eligible(self, o):
        corners = sum(corner["object"] == o["object"] for corner in self.corners)
        return np.prod(o["box"][2:] - o["box"][:2]) >= 400 and corners >= 4 and o["visible_fraction"] >= 0.5

    def odds(self, box):
        odds = [c["odds"] for c in self.corners
                if c["verdict"] == "rebel" and (np.array([c["x"], c["y"]]) >= box[:2]).all()
                and (np.array([c["x"], c["y"]]) <= box[2:]).all()]
        return float(np.mean(odds)) if odds else 0.0

    def truth_pixels(self):
        pixels = np.zeros(self.size, np.uint8)
        for o in self.moving:
            high, wide = o["bottom"] - o["top"], o["right"] - o["left"]
            own = coco_mask.decode({"size": [high, wide], "counts": o["mask"]})
            pixels[o["top"]:o["bottom"], o["left"]:o["right"]] |= own
        return pixels

    def found_pixels(self):
        pixels = np.zeros(self.size, np.uint8)
        y, x = np.mgrid[0:self.size[0], 0:self.size[1]]
        for s in self.all_squares:
            inside = np.ones(self.size, bool)
            rim = np.array(s["outline"]).reshape(-1, 2)
            for a, b in zip(rim, np.roll(rim, -1, axis=0)):
                side = (b - a) / np.linalg.norm(b - a)
                inside &= side[0] * (y - a[1]) - side[1] * (x - a[0]) >= -1e-6
            pixels |= inside
        return pixels


def of_tracks(frames):
    objects = {id: i for i, id in enumerate(dict.fromkeys(o["object"] for f in frames for o in f.wanted))}
    tracks = {id: i for i, id in enumerate(dict.fromkeys(s["id"] for f in frames for s in f.squares))}
    data = {
        "num_gt_ids": len(objects), "num_tracker_ids": len(tracks), "num_timesteps": len(frames),
        "num_gt_dets": sum(len(f.wanted) for f in frames), "num_tracker_dets": sum(len(f.squares) for f in frames),
        "gt_ids": [np.array([objects[o["object"]] for o in f.wanted], int) for f in frames],
        "tracker_ids": [np.array([tracks[s["id"]] for s in f.squares], int) for f in frames],
        "similarity_scores": [overlaps(f.wanted, f.squares) for f in frames],
    }
    quiet = {"PRINT_CONFIG": False}
    hota, clear, identity = HOTA().eval_sequence(data), CLEAR(quiet).eval_sequence(data), Identity(quiet).eval_sequence(data)
    return {"mover.hota": np.mean(hota["HOTA"]), "mover.hota_detection": np.mean(hota["DetA"]),
            "mover.hota_association": np.mean(hota["AssA"]), "mover.mota": clear["MOTA"],
            "mover.identity_changes": clear["IDSW"], "mover.idf1": identity["IDF1"]}


def of_boxes(frames):
    def annotation(box, image, **more):
        x, y, width, height = *box[:2], *(box[2:] - box[:2])
        return {"image_id": image, "category_id": 1, "bbox": [x, y, width, height], **more}

    truth = COCO()
    found = [annotation(s["box"], k, score=s["odds"]) for k, f in enumerate(frames) for s in f.squares]
    wanted = [annotation(o["box"], k, area=1, iscrowd=0) for k, f in enumerate(frames) for o in f.wanted]
    truth.dataset = {"images": [{"id": k} for k in range(len(frames))], "categories": [{"id": 1, "name": "mover"}],
                     "annotations": [{"id": i + 1, **a} for i, a in enumerate(wanted)]}
    if not found:
        return {"mover.average_precision": 0}
    with contextlib.redirect_stdout(io.StringIO()):
        truth.createIndex()
        evaluation = COCOeval(truth, truth.loadRes(found), "bbox")
        evaluation.params.iouThrs = np.array([0.5])
        evaluation.params.areaRng, evaluation.params.areaRngLbl = [[0, 1e12]], ["all"]
        evaluation.params.maxDets = [10000]
        evaluation.evaluate()
        evaluation.accumulate()
    return {"mover.average_precision": evaluation.eval["precision"].mean()}


def of_pixels(frames):
    pairs = [(f.truth_pixels(), f.found_pixels()) for f in frames if f.moving]
    packed = [[[coco_mask.encode(np.asfortranarray(pixels))] for pixels in side] for side in zip(*pairs)]
    j = JAndF._compute_j(*packed, 1, 1, len(pairs))[0, 0]
    f = JAndF._compute_f(*packed, 0, 0, 0.008)
    common, both = (sum(np.count_nonzero(op(a, b)) for a, b in pairs) for op in (np.logical_and, np.logical_or))
    return {"mover.region_j": np.mean(j), "mover.boundary_f": np.mean(f),
            "mover.j_and_f": (np.mean(j) + np.mean(f)) / 2, "mover.pixel_iou": common / both}


def of_corners(frames, first):
    """Interpolates scikit-learn's curve at 101 recalls, as COCO does."""
    counted = [(c["label"] == "rebel", c["odds"]) for k, f in frames for c in f.corners
               if c["label"] == "fixed" or (c["label"] == "rebel" and k >= first[c["object"]] + WARM_UP)]
    moves, odds = np.array(counted).T
    if not moves.any():
        return {"rebel.average_precision": None}
    precision, recall, _ = precision_recall_curve(moves, odds)
    precision, recall = precision[:-1], recall[:-1]  # without the point that it adds at recall 0
    return {"rebel.average_precision": np.mean([
        precision[recall >= at].max(initial=0) for at in np.arange(101) * 0.01])}


def compare(run):
    camera = json.loads((run / "camera.json").read_text())
    size = (camera["height_px"], camera["width_px"])
    layers, truth = ([line for line in lines(run / name) if "corners" in line]
                     for name in ("layers.jsonl", "truth.jsonl"))
    moved, first, frames = set(), {}, []
    for k, (l, t) in enumerate(zip(layers, truth)):
        frame = Frame(l, t, moved, size)
        for c in frame.corners:
            if c["label"] == "rebel":
                first.setdefault(c["object"], k)
        if k >= WARM_UP:
            frames.append((k, frame))
    plain = [f for _, f in frames]
    want = of_corners(frames, first)
    if any(f.wanted for f in plain):
        want |= of_tracks(plain) | of_boxes(plain)
    if any(f.moving for f in plain):
        want |= of_pixels([f for f in plain if f.truth_pixels().any()])
    figures = json.loads((run / "metrics.json").read_text())
    for key, value in want.items():
        own = figures[key]
        if (own is None) != (value is None) or (own is not None and abs(own - value) > TOLERANCE):
            sys.exit(f"FAILED: {run.name}: {key} is {own}, and {value} by the library")
    return {key for key, value in want.items() if value is not None}


def main():
    compared = [compare(pathlib.Path(run)) for run in sys.argv[1:]]
    print(f"fine: {len(compared)} runs; " + ", ".join(
        f"{key} in {sum(key in keys for keys in compared)}" for key in sorted(set().union(*compared))))
    if not any("mover.hota" in keys for keys in compared):
        sys.exit("FAILED: nothing moves in any run")


main()
