#!/usr/bin/env python3
"""FoELS as a detector: pixels that do not flow away from the focus of expansion move by themselves.

    lcs run scenarios/crossing.yaml --detector foels --detector-command 'python3 tests/comparators/rivals/foels.py'

After Ogawa, An and Yamashita, "Moving Object Detection from Moving Camera Using Focus of Expansion Likelihood and
Segmentation" (arXiv 2507.13628), from its abstract, its authors' page and quoted equations. Theirs: the focus by
RANSAC over pairs of dense flow vectors, with inliers by angle; a camera that stands if few pixels flow; probability
to move by the flow's angle to the focus and the logarithm of its length; segments that move as a whole. Ours:
  * DIS in place of a network's flow, to an earlier picture that the told rotation turns;
  * superpixels in place of a network's panoptic segments: there are no classes, so no prior of a class, and the focus
    comes from the whole picture; superpixels that touch are an object;
  * pixels without texture do not count, as DIS only guesses their flow.
The inliers' 2 deg and the length's 0.25 are the defaults of the authors' repository. The others
were chosen on every third frame of the first 28 worlds of `train`, with a weight of .1 for the
length, and before superpixels of little texture were left out (F1 of corners; false objects per
100 frames):
  * angle of probability 0.5: 6 / 10 / 15 / 30 deg (the paper's): .372 / .371 / .340 / .323;
    41 / 29 / 25 / 22;
  * share of flow below which the camera stands: .35 / .5 / .65: .361 / .371 / .382; in static
    worlds 16 / 29 / 40;
  * pixels without texture counted: .342; 49. Without the told rotation .375, without the flow's
    length .369, to a picture of 0.1 s before .358.
Flow is px from the earlier picture to this one, at every second pixel: (rows, columns, 2), x first.
"""
import cv2
import numpy as np

from detector_kit import run, turned_by

SHORT_PX = 1.0  # shorter flow has no angle
STANDS = 0.5  # the camera stands if a smaller share of the textured pixels flows
INLIER_DEG = 2.0  # largest angle of static flow
MIDDLE_DEG = 10.0  # angle with probability 0.5
LENGTH = 0.25  # probability of flow ten times longer, or shorter, than static flow is in the mean
TEXTURE = 2e-4  # least eigenvalue (cv2.cornerMinEigenVal) of a textured pixel
SHARE = 0.5  # least share of moving pixels in a superpixel that moves
CELL = 12  # of superpixels, in pixels of the flow
DRAWS = 200  # of RANSAC

dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)


def cosine(focus, places, flow):
    """Of the angle between flow and static flow. The homogeneous focus (..., 3) contracts if its last is negative."""
    static = places * focus[..., 2:] - focus[..., :2]
    length = np.linalg.norm(static, axis=-1) * np.linalg.norm(flow, axis=-1)
    return np.sum(static * flow, axis=-1) / np.maximum(length, 1e-9)


def focus_of(places, flow):
    """The homogeneous focus (3,) of most flow vectors; `places` and `flow` have shape (n, 2)."""
    (x, y), (u, v) = places.T, flow.T
    lines = np.c_[v, -u, u * y - v * x]  # line . (x, y, 1) = 0
    first, second = np.random.default_rng(1).integers(0, len(flow), (2, DRAWS))
    foci = np.cross(lines[first], lines[second])
    foci = np.concatenate([foci, -foci])
    inliers = cosine(foci[:, None], places, flow) > np.cos(np.radians(INLIER_DEG))
    return foci[np.argmax(inliers.sum(axis=1))]


def moving(places, flow, textured):
    """Whether each pixel moves by itself."""
    length = np.linalg.norm(flow, axis=-1)
    flows = (length > SHORT_PX) & textured
    some = np.s_[2::5, 2::5]
    if flows.sum() <= STANDS * textured.sum() or not flows[some].any():
        return flows
    focus = focus_of(places[some][flows[some]], flow[some][flows[some]])
    angle = np.degrees(np.arccos(np.clip(cosine(focus, places, flow), -1, 1)))
    static = np.append(length[flows & (angle < INLIER_DEG)], SHORT_PX).mean()
    by_length = np.abs(np.log10(np.maximum(length, 0.1) / static))
    return textured & (flows * angle / MIDDLE_DEG / 2 + LENGTH * by_length > 0.5)


def detect(camera, grey, corners, earlier, R_cur_prev):
    size = grey.shape[::-1]
    turned = cv2.warpPerspective(earlier, turned_by(camera, R_cur_prev), size, borderMode=cv2.BORDER_REPLICATE)
    flow = -dis.calc(grey, turned, None)[::2, ::2]
    rows, columns = flow.shape[:2]
    places = 2.0 * np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
    small = cv2.resize(grey, (columns, rows), interpolation=cv2.INTER_AREA)
    textured = cv2.cornerMinEigenVal(small, 5) > TEXTURE
    numbers = np.zeros(small.shape, np.int32)  # of superpixels, by the watershed from a grid of seeds; 0 between them
    seeds = numbers[CELL // 2::CELL, CELL // 2::CELL]
    seeds[:] = np.arange(1, seeds.size + 1).reshape(seeds.shape)
    numbers = np.maximum(cv2.watershed(cv2.cvtColor(small, cv2.COLOR_GRAY2BGR), numbers), 0)
    move, all_ = (np.bincount(numbers.ravel(), one.ravel()) for one in (moving(places, flow, textured), textured))
    mask = np.uint8(move > SHARE * np.maximum(all_, CELL * CELL / 8))[numbers]  # texture: an eighth at least
    _, parts = cv2.connectedComponents(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((3, 3))))
    column, row = np.clip(np.rint(corners / 2).astype(int), 0, [columns - 1, rows - 1]).T
    part = parts[row, column]
    return [np.flatnonzero(part == k) for k in np.unique(part[part > 0])]


run(detect)
