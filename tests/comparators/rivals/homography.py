#!/usr/bin/env python3
"""A detector without the told motion: corners whose motion no single homography of the picture explains.

    lcs run scenarios/crossing.yaml --detector homography \\
        --detector-command 'python3 tests/comparators/rivals/homography.py'

Valid for a far or flat world, and for a camera that only rotates, as most published code for moving cameras assumes.
"""
import cv2
import numpy as np

from detector_kit import run

INLIER_PX = 0.7  # of RANSAC
OFF_PX = 2.0  # largest distance of a static corner from its mapped place
NEAR_PX = 120  # largest distance between neighbours in a group
LEAST = 8  # fewest tracked corners for a fit


def detect(camera, grey, corners, earlier, R_cur_prev):
    before, found, _ = cv2.calcOpticalFlowPyrLK(grey, earlier, corners, None, winSize=(15, 15))
    found = np.flatnonzero(found.ravel() == 1)
    if len(found) < LEAST:
        return []
    H, _ = cv2.findHomography(before[found], corners[found], cv2.RANSAC, INLIER_PX, maxIters=2000, confidence=0.995)
    if H is None:
        return []
    mapped = cv2.perspectiveTransform(before[found, None], H)[:, 0]
    off = found[np.linalg.norm(corners[found] - mapped, axis=1) > OFF_PX]
    near = np.linalg.norm(corners[off, None] - corners[off], axis=2) < NEAR_PX
    left, groups = np.ones(len(off), bool), []
    while left.any():
        reached = np.zeros(len(off), bool)
        reached[np.argmax(left)] = True
        while (more := near[reached].any(axis=0) & left & ~reached).any():
            reached |= more
        left &= ~reached
        groups.append(off[reached])
    return groups


run(detect)
