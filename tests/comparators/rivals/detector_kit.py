"""Shared by the rivals: reads frames, keeps the earlier picture, writes answers (PROTOCOL.md).

Places and flow are px, x first; a box is [left, top, width, height], px.
"""
import json
import sys

import cv2
import numpy as np

BASELINE_S = 0.055  # age of the earlier picture, as in flow_detectors.h
LEAST = 5  # fewest corners of an object, as in rebel_groups.h


def box_of(points):
    return np.append(points.min(axis=0), np.ptp(points, axis=0) + 1)  # both ends included


def turned_by(camera, R_cur_prev):
    """The homography (3, 3) by which a rotation moves pixels of the earlier picture."""
    (x, y), f = camera["centre_px"], camera["focal_px"]
    K = np.array([[f, 0, x], [0, f, y], [0, 0, 1]])
    return K @ R_cur_prev @ np.linalg.inv(K)


def run(detect):
    """Asks `detect(camera, grey, corners, earlier, R_cur_prev)` for each frame's movers: arrays of corners' indices.

    `grey` and `earlier`, with the age nearest to BASELINE_S, are uint8 (height, width); `corners` float32 (n, 2);
    R_cur_prev (3, 3) is told, from the earlier camera to this one. Without `earlier` or corners it is not asked.
    """
    header = json.loads(sys.stdin.buffer.readline())
    camera, size = header["camera"], header["picture"]["bytes"]
    print(json.dumps({"protocol": 1, "circles": True}), flush=True)
    kept = []  # (grey, R_cur_prev, age in s), newest first
    for line in sys.stdin.buffer:
        frame = json.loads(line)
        pixels = np.frombuffer(sys.stdin.buffer.read(size), np.uint8)
        grey = cv2.cvtColor(pixels.reshape(camera["height_px"], camera["width_px"], 3), cv2.COLOR_BGR2GRAY)
        corners = np.float32([frame["corners"]["x"], frame["corners"]["y"]]).T.reshape(-1, 2)
        motion = frame["told_motion"] or {"dt_s": 0, "R_cur_prev": np.eye(3)}
        R, dt_s = np.reshape(motion["R_cur_prev"], (3, 3)), motion["dt_s"]
        kept = [(old, R @ turned, age + dt_s) for old, turned, age in kept if dt_s > 0]
        answer = {"index": frame["index"], "rebel": [], "box": [], "circle": []}
        if kept and len(corners):
            earlier, turned, _ = min(kept, key=lambda one: abs(one[2] - BASELINE_S))
            movers = [one for one in detect(camera, grey, corners, earlier, turned) if len(one) >= LEAST]
            for number, members in enumerate(movers):
                box = box_of(corners[members])
                middle = box[:2] + (box[2:] - 1) / 2
                radius = np.linalg.norm(corners[members] - middle, axis=1).max()
                answer["rebel"] += members.tolist()
                answer["box"].append([number, *box.tolist()])  # ids do not persist
                answer["circle"].append([*middle.tolist(), float(radius)])
        print(json.dumps(answer), flush=True)
        kept = [(grey, np.eye(3), 0.0)] + [one for one in kept if one[2] < BASELINE_S]
