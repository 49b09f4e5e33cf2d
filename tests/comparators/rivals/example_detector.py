#!/usr/bin/env python3
"""A detector to start from: Lucas-Kanade, and the distance to the epipolar line of the motion told.

    lcs run scenarios/crossing.yaml --detector lk \\
        --detector-command 'python3 tests/comparators/rivals/example_detector.py'

Needs python3-opencv and python3-numpy. tools/comparators/PROTOCOL.md says what comes in and goes out.
"""
import json
import sys

import cv2
import numpy as np

OFF_PX = 1.0  # largest distance of a static corner from its epipolar line
NEAR_PX = 80  # largest distance between neighbours in a group
LEAST = 5  # fewest corners of a group


def moves_by_itself(camera, motion, now, before):
    """Whether each corner, tracked from `before` to `now`, is off the line that a static one keeps to."""
    f, c = camera["focal_px"], np.array(camera["centre_px"])
    ray = lambda px: np.c_[(px - c) / f, np.ones(len(px))]
    turned = ray(before) @ np.reshape(motion["R_cur_prev"], (3, 3)).T  # rotated by the camera
    went = np.array(motion["v_C_mps"]) * motion["dt_s"]  # displacement, current camera frame
    line = np.cross(np.broadcast_to(went, turned.shape), turned)  # static: line . ray = 0
    length = np.linalg.norm(line[:, :2], axis=1)
    still = np.linalg.norm(now - (turned[:, :2] / turned[:, 2:] * f + c), axis=1)
    off = np.abs(np.sum(line * ray(now), axis=1)) * f / np.maximum(length, 1e-9)
    return np.where(length > 1e-6, off, still) > OFF_PX  # no line: the camera stands still


def groups_of(points):
    """Lists of places in `points` whose neighbours are near, the largest groups there are."""
    left, groups = np.ones(len(points), bool), []
    while left.any():
        group = [int(np.argmax(left))]
        left[group] = False
        for i in group:  # grows in the loop
            near = np.flatnonzero(left & (np.linalg.norm(points - points[i], axis=1) < NEAR_PX))
            left[near] = False
            group += near.tolist()
        groups.append(group)
    return [group for group in groups if len(group) >= LEAST]


def main():
    header = json.loads(sys.stdin.buffer.readline())
    camera, picture = header["camera"], header["picture"]
    print(json.dumps({"protocol": 1, "circles": True}), flush=True)
    last = None
    for line in sys.stdin.buffer:
        frame = json.loads(line)
        pixels = np.frombuffer(sys.stdin.buffer.read(picture["bytes"]), np.uint8)
        image = pixels.reshape(camera["height_px"], camera["width_px"], 3)  # BGR
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        corners = np.float32([frame["corners"]["x"], frame["corners"]["y"]]).T.reshape(-1, 2)
        answer = {"index": frame["index"], "rebel": [], "pending": [], "box": [], "circle": []}
        motion = frame["told_motion"]
        if last is not None and motion and motion["dt_s"] > 0 and len(corners):
            before, found, _ = cv2.calcOpticalFlowPyrLK(grey, last, corners, None, winSize=(15, 15))
            found = found.ravel() == 1
            off = np.flatnonzero(found & moves_by_itself(camera, motion, corners, before))
            for number, group in enumerate(groups_of(corners[off])):
                members = off[group]
                low, high = corners[members].min(axis=0), corners[members].max(axis=0)
                size = high - low + 1  # px, both ends included
                radius = np.linalg.norm(corners[members] - (low + high) / 2, axis=1).max()
                answer["rebel"] += members.tolist()
                answer["box"].append([number, *low.tolist(), *size.tolist()])  # ids do not persist
                answer["circle"].append([*((low + high) / 2).tolist(), float(radius)])
            answer["pending"] = np.flatnonzero(~found).tolist()
        print(json.dumps(answer), flush=True)
        last = grey


main()
