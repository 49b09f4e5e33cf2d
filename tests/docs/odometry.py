#!/usr/bin/env python3
"""Measures by how much the filter's verdicts help a visual odometry, which movers spoil.

    lcs suite --worlds test --count 40 --keep all --out out/odometry
    python3 tests/docs/odometry.py out/odometry   # prints its table as Markdown; --full: all of it
    python3 tests/docs/odometry.py --self-test

Needs python3-opencv, with numpy. Four steps:

Pairs. A frame forms a pair with the later frame of the pair before, or with the frame
MOST_FRAMES earlier if that one is later still; but only if the camera's way between them is at
least LEAST_M by the truth, so that there are no pairs while the rover stands. The pictures are
those that the run keeps: JPEG, at most 640 px wide.

Matches. Pyramidal Lucas-Kanade follows the corners (FAST's) of the later frame back to the
earlier one, frame by frame, from where the told rotation puts them; then once more across the
whole pair, and back to the later frame. Corners that return more than RETURN_PX from their
place are left out. The filter's tracks are not used: all sets of corners take the same matches.

Sets, by the verdicts of the later frame: all corners; those that are not rebels; those that are
normal (neither pending nor ignored either); those outside of the squares that move; those that
the truth has static. The last are on bodies that rest from the earlier frame to the later one,
off the outlines of movers, off the edges of shadows, the sky and the rover itself.

Estimates, of the direction in which the camera moved, in its frame at the later picture:
  * "gyroscope, RANSAC 0.25 px", the main one. The rotation is the told one, which the run's
    estimator integrates from the gyroscope. A static point with the places x (later) and y
    (earlier, turned) has u . (y x x) = 0 with the direction u, so that two matches give u. Of
    DRAWS, the u with most matches within 0.25 px of their epipolar lines is refined by the
    least squares of these distances. By its sign, the median parallax leads from the epipole.
  * "gyroscope, RANSAC 1 px": the same with OpenCV's default threshold.
  * "gyroscope, least squares": the same with all matches, without RANSAC.
  * "essential matrix, RANSAC 0.25 px": cv2.findEssentialMat and cv2.recoverPose; no gyroscope.
With fewer than LEAST_MATCHES matches, or without an estimate, the direction before is kept.

Error: the angle to the true direction, over the pairs of all worlds. Drift: steps with the
estimated direction, the true length and the true orientation are summed up, so that only
directions count; |estimated end - true end| / true path, the mean over worlds. Intervals (95 %)
are of the difference to all corners, by bootstrap over worlds.

Chosen on 40 worlds of `train`: the thresholds, of 0.125, 0.25, 0.5, 1 and 2 px, by the least
drift with all corners, so that RANSAC alone does its best (with the essential matrix, of 0.25,
0.5 and 1 px); LEAST_M, of 0.05, 0.1 and 0.2 m, as 0.2 leaves out three more worlds, and 0.05
raises the median error of the static corners by a third. Also tried: inliers only with their
parallax away from the epipole, by which all corners drift 0.9 % in place of 2.2 % at 0.5 px, and
3.6 % in place of 5.7 % at 1 px. On train the rebels do not matter at the 0.25 px chosen (0.70 %
with and without them, in November 2026), and do at 1 px (5.7 and 0.7 %).
"""
import argparse
import gzip
import json
import multiprocessing
import pathlib

import cv2
import numpy as np

LEAST_M = 0.1
MOST_FRAMES = 10
RETURN_PX = 1.0
LEAST_MATCHES = 8
DRAWS = 300
WARM_UP = 3  # frames
MANY = 0.2  # share of the corners that movers hold in a pair with many
SETS = ["all", "not rebels", "normal", "outside of moving squares", "static (truth)"]
ESTIMATES = {"gyroscope, RANSAC 0.25 px": 0.25, "gyroscope, RANSAC 1 px": 1.0,
             "gyroscope, least squares": None, "essential matrix, RANSAC 0.25 px": 0.25}


# Geometry. Places are rows (x, y, 1) with focal length 1: shape (n, 3).

def line_lengths(u, y):
    """Of the normals (first two numbers) of the epipolar lines u x y: shape (..., n)."""
    u = u[..., None, :]
    return np.hypot(u[..., 1] - u[..., 2] * y[:, 1], u[..., 2] * y[:, 0] - u[..., 0])


def distances(u, x, y):
    """From x to the epipolar lines of y for directions u (..., 3): (..., n), focal length 1."""
    return np.abs(u @ np.cross(y, x).T) / np.maximum(line_lengths(u, y), 1e-12)


def signed(u, x, y):
    """u or -u: the one with the median of the parallax away from the epipole."""
    away = y[:, :2] * u[2] - u[:2]
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
    return u if np.median(((x - y)[:, :2] * away).sum(1)) >= 0 else -u


def least_squares(x, y, u=None, within=np.inf):
    """The unit u (3,) of least squared distances, over the matches within a distance of it."""
    normals = np.cross(y, x)
    weights, use = np.ones(len(x)), np.ones(len(x), bool)
    for _ in range(10):
        if u is not None:
            weights = 1 / np.maximum(line_lengths(u, y), 1e-6)
            use = distances(u, x, y) <= within
        if use.sum() < 3:
            break
        u = np.linalg.svd((normals * weights[:, None])[use], full_matrices=False)[2][-1]
    return signed(u, x[use], y[use]) if use.any() else u


def two_point_ransac(x, y, within, seed=0):
    """The unit u (3,), or None; `within` is a distance with focal length 1."""
    normals = np.cross(y, x)
    first, second = np.random.default_rng(seed).integers(0, len(x), (2, DRAWS))
    tried = np.cross(normals[first], normals[second])
    length = np.linalg.norm(tried, axis=1)
    tried = tried[length > 0] / length[length > 0, None]
    if not len(tried):
        return None
    best = np.argmax((distances(tried, x, y) <= within).sum(1))
    return least_squares(x, y, tried[best], within)


def by_essential_matrix(x, z, within):
    """The unit u (3,), or None, of places x (later) and z (earlier, not turned)."""
    cv2.setRNGSeed(0)
    x, z = x[:, :2].copy(), z[:, :2].copy()
    E, mask = cv2.findEssentialMat(z, x, np.eye(3), cv2.RANSAC, 0.999, within)
    if E is None or E.shape[0] < 3:
        return None
    return -cv2.recoverPose(E[:3], z, x, np.eye(3), mask=mask)[2][:, 0]


# Recordings

def frames_of(path):
    with gzip.open(path, "rt") as file:
        return [frame for frame in map(json.loads, file) if "corners" in frame]


def pictures_of(path):
    """Grey pictures of a Motion JPEG file."""
    start = b"\xff\xd8\xff"
    return [cv2.imdecode(np.frombuffer(start + part, np.uint8), cv2.IMREAD_GRAYSCALE)
            for part in path.read_bytes().split(start)[1:]]


def follow(from_picture, to_picture, places, guess):
    """Where Lucas-Kanade finds places (n, 2) px, and whether it does."""
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        from_picture, to_picture, np.float32(places)[:, None], np.float32(guess)[:, None].copy(),
        winSize=(15, 15), maxLevel=3, flags=cv2.OPTFLOW_USE_INITIAL_FLOW)
    return np.float64(found[:, 0]), status[:, 0] > 0


def inside_moving_squares(squares, places):
    """Whether each place (n, 2) px is inside of the outline of a square that moves."""
    inside = np.zeros(len(places), bool)
    for i, outline in enumerate(squares["outline"]):
        if squares["circles"][i] and not squares["rebel_circles"][i]:
            continue  # it rests
        if len(outline) < 3:
            x, y, w, h = (squares[name][i] for name in ["x", "y", "half_width", "half_height"])
            outline = [[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]]
        inside |= np.array([cv2.pointPolygonTest(np.float32(outline), place, False) >= 0
                            for place in places.tolist()], bool)
    return inside


class Run:
    """A recorded run. Pixels are of its pictures, which may be smaller than the camera's image."""

    def __init__(self, folder):
        self.layers = frames_of(folder / "layers.jsonl.gz")
        self.truth = frames_of(folder / "truth.jsonl.gz")
        self.pictures = pictures_of(folder / "pictures.mjpeg")
        assert len(self.layers) == len(self.truth) == len(self.pictures), folder
        camera = json.loads((folder / "camera.json").read_text())
        self.focal_px, self.centre_px = camera["focal_px"], np.array(camera["centre_px"])
        self.scale = self.pictures[0].shape[1] / camera["width_px"]

    def rays(self, picture_px):
        image_px = (picture_px + 0.5) / self.scale - 0.5
        return np.c_[(image_px - self.centre_px) / self.focal_px, np.ones(len(image_px))]

    def picture_px(self, rays):
        image_px = rays[:, :2] / rays[:, 2:] * self.focal_px + self.centre_px
        return (image_px + 0.5) * self.scale - 0.5

    def told_rotation(self, k):
        return np.reshape(self.layers[k]["told_motion"]["R_cur_prev"], (3, 3))

    def true_rotation(self, k):
        return np.reshape(self.truth[k]["true_motion"]["R_cur_prev"], (3, 3))

    def way(self, earlier, k):
        """The camera's true way from frame `earlier` to k, in its frame at k, in m: shape (3,)."""
        way = np.zeros(3)
        for j in range(earlier + 1, k + 1):
            motion = self.truth[j]["true_motion"]
            way = self.true_rotation(j) @ way + np.array(motion["v_C_mps"]) * motion["dt_s"]
        return way

    def orientations(self):
        """Of the camera in each frame, in its frame at the first one."""
        turned = [np.eye(3)]
        for k in range(1, len(self.truth)):
            turned.append(turned[-1] @ self.true_rotation(k).T)
        return turned

    def pairs(self):
        last = WARM_UP
        for k in range(WARM_UP + 1, len(self.layers)):
            last = max(last, k - MOST_FRAMES)
            if not self.layers[k]["told_motion"]["dt_s"]:
                last = k  # no told rotation
            elif np.linalg.norm(self.way(last, k)) >= LEAST_M:
                yield last, k
                last = k

    def matches(self, earlier, k):
        """Numbers of corners (n,) at k, and their places x, y and z (y, not turned): (n, 3)."""
        corners = self.layers[k]["corners"]
        start = (np.c_[corners["x"], corners["y"]].astype(float) + 0.5) * self.scale - 0.5
        if not len(start):
            return np.zeros(0, int), *np.zeros((3, 0, 3))
        R, places, good = np.eye(3), start, np.ones(len(start), bool)
        for j in range(k, earlier, -1):
            step = self.told_rotation(j)
            guess = self.picture_px(self.rays(places) @ step)  # rows: step.T times each
            places, found = follow(self.pictures[j], self.pictures[j - 1], places, guess)
            good &= found
            R = R @ step
        if k - earlier > 1:
            places, found = follow(self.pictures[k], self.pictures[earlier], start, places)
            good &= found
        back, found = follow(self.pictures[earlier], self.pictures[k], places, start)
        good &= found & (np.linalg.norm(back - start, axis=1) <= RETURN_PX)
        z = self.rays(places)
        y = z @ R.T
        good &= y[:, 2] > 0.1  # in front of the camera
        return np.flatnonzero(good), self.rays(start)[good], (y / y[:, 2:])[good], z[good]

    def sets(self, earlier, k, numbers):
        """Which of these corners of frame k are in each of SETS, and which are on movers."""
        said, truth = self.layers[k], self.truth[k]["corners"]
        verdicts = np.array(said["corners"]["verdict"])[numbers]
        places = np.c_[said["corners"]["x"], said["corners"]["y"]].astype(float)[numbers]
        moving = set()
        for j in range(earlier, k):  # the truth's "moving" is from j to j+1
            objects = self.truth[j]["objects"]
            moving |= {one for one, moves in zip(objects["object"], objects["moving"]) if moves}
        movers = np.isin(np.array(truth["object"])[numbers], list(moving))
        static = ~movers & (np.array(truth["label"])[numbers] != "none")
        static &= ~np.array(truth["outline"], bool)[numbers]
        return [np.ones(len(numbers), bool), verdicts != "rebel", verdicts == "normal",
                ~inside_moving_squares(said["squares"], places), static], movers


def estimate(name, x, y, z, focal_px, seed):
    """The direction by one of ESTIMATES, or None."""
    if len(x) < LEAST_MATCHES:
        return None
    if not ESTIMATES[name]:
        return least_squares(x, y)
    within = ESTIMATES[name] / focal_px
    if name.startswith("essential"):
        return by_essential_matrix(x, z, within)
    return two_point_ransac(x, y, within, seed)


def angle_deg(u, v):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))


def measure(folder):
    """A dictionary for each pair of a run; its arrays have the shape (estimates, sets, ...)."""
    run, rows = Run(folder), []
    orientations = run.orientations()
    directions = np.tile([0.0, 0, 1], (len(ESTIMATES), len(SETS), 1))  # before the first: ahead
    for earlier, k in run.pairs():
        numbers, x, y, z = run.matches(earlier, k)
        sets, movers = run.sets(earlier, k, numbers)
        way = run.way(earlier, k)
        length = np.linalg.norm(way)
        none = np.zeros(directions.shape[:2], bool)
        for e, name in enumerate(ESTIMATES):
            for s, use in enumerate(sets):
                u = estimate(name, x[use], y[use], z[use], run.focal_px, seed=k)
                none[e, s] = u is None
                if u is not None:
                    directions[e, s] = u
        rows.append({
            "pair": (earlier, k), "length_m": length, "matches": [use.sum() for use in sets],
            "movers": movers.mean() if len(movers) else 0.0, "none": none,
            "error_deg": np.apply_along_axis(angle_deg, 2, directions, way),
            "off_m": (directions * length - way) @ orientations[k].T})
    return rows


# Figures

def drift(rows):
    """Share of a run's path: shape (estimates, sets)."""
    off = np.linalg.norm(sum(row["off_m"] for row in rows), axis=-1)
    return off / sum(row["length_m"] for row in rows)


def figures(worlds):
    """Of a list of worlds' rows, by heading: arrays (estimates, sets)."""
    rows = [row for world in worlds for row in world]
    errors = np.array([row["error_deg"] for row in rows])
    many = errors[[row["movers"] > MANY for row in rows]]
    if not len(many):
        many = np.full((1, *errors.shape[1:]), np.nan)
    return {"median (deg)": np.median(errors, 0),
            "90th percentile (deg)": np.percentile(errors, 90, 0),
            "drift (%)": 100 * np.mean([drift(world) for world in worlds], 0),
            "many movers: median (deg)": np.median(many, 0),
            "many movers: 90th (deg)": np.percentile(many, 90, 0)}


def less_than_all(worlds, draws=2000):
    """Intervals of the difference to all corners: {heading: (2, estimates, sets)}."""
    random = np.random.default_rng(1)
    drawn = [figures([worlds[i] for i in random.integers(0, len(worlds), len(worlds))])
             for _ in range(draws)]
    return {name: np.nanpercentile([one[name][:, :1] - one[name] for one in drawn], [2.5, 97.5], 0)
            for name in drawn[0]}


def markdown(rows):
    rows = [rows[0], ["---"] * len(rows[0]), *rows[1:]]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def short_table(values, intervals):
    """The main columns of three sets of corners."""
    names = ["median (deg)", "90th percentile (deg)", "drift (%)", "many movers: 90th (deg)"]
    rows = [["estimate", "corners", *names, "drift less than with all"]]
    drifts, (low, high) = values["drift (%)"], intervals["drift (%)"]
    for e, name in enumerate(ESTIMATES):
        for s in [0, 1, len(SETS) - 1]:
            less = f"{drifts[e, 0] - drifts[e, s]:.1f} ({low[e, s]:.1f} to {high[e, s]:.1f})"
            rows.append([name if not s else "", SETS[s], *(f"{values[n][e, s]:.2f}" for n in names),
                         less if s else "-"])
    return markdown(rows)


def tables(values, intervals):
    """Two tables: the figures; and how much less than all corners' they are, with intervals."""
    first = [["estimate", "corners", *values]]
    second = [["less than with all corners", "corners", *values]]
    for e, name in enumerate(ESTIMATES):
        for s, chosen in enumerate(SETS):
            head = [name if not s else "", chosen]
            first.append(head + [f"{value[e, s]:.2f}" for value in values.values()])
        for s in [1, len(SETS) - 1]:
            second.append([name if s == 1 else "", SETS[s], *(
                f"{value[e, 0] - value[e, s]:.2f} ({low[e, s]:.2f} to {high[e, s]:.2f})"
                for value, (low, high) in zip(values.values(), intervals.values()))])
    return markdown(first) + "\n\n" + markdown(second)


def report(runs, is_full):
    """Prints a sentence for README.md, the facts and the tables, of `measure`'s rows by run."""
    worlds = [rows for rows in runs if rows]
    rows = [row for world in worlds for row in world]
    many = [[row["movers"] > MANY for row in world] for world in worlds]
    none = np.mean([row["none"] for row in rows], 0)[0]
    values, intervals = figures(worlds), less_than_all(worlds)
    drifts, (low, high) = values["drift (%)"][0], intervals["drift (%)"][:, 0, 1]
    less = np.array([drift(world)[0, 0] - drift(world)[0, 1] for world in worlds])
    print(f"Leaving the rebels out changes the drift of a visual odometry (gyroscope, RANSAC) "
          f"from {drifts[0]:.1f} to {drifts[1]:.1f} % of the path "
          f"(less by {drifts[0] - drifts[1]:.1f}, 95 % interval {low:.1f} to {high:.1f}); "
          f"with the truly static corners it is {drifts[-1]:.1f} %.\n")
    print(f"{len(rows)} pairs of {len(worlds)} worlds; in {len(runs) - len(worlds)} more the "
          f"camera stands or crawls. Movers hold over {100 * MANY:.0f} % of the corners in "
          f"{100 * np.mean(sum(many, [])):.0f} % of the pairs, in {sum(map(any, many))} worlds. "
          f"Without the rebels the drift is less by over 0.1 % of the path in "
          f"{sum(less > 0.001)} worlds, and more in {sum(less < -0.001)}. Too few corners are "
          f"left in {100 * none[1]:.1f} % of the pairs.\n")
    print((tables if is_full else short_table)(values, intervals))


def self_test():
    """Synthetic points with a known motion: exact ones, then with two fifths on a mover."""
    random = np.random.default_rng(1)
    within, n, mover = 1 / 400, 300, slice(0, 120)
    for case in range(20):
        u = random.normal(size=3)
        u /= np.linalg.norm(u)
        turn, _ = cv2.Rodrigues(random.normal(scale=0.05, size=3))
        points = np.c_[random.uniform(-1, 1, (n, 2)), np.ones(n)] * random.uniform(2, 12, (n, 1))
        before = (points + 0.2 * u) @ turn  # in the earlier frame; rows: turn.T times each
        x, z = points / points[:, 2:], before / before[:, 2:]
        y = z @ turn.T
        y /= y[:, 2:]
        for found in two_point_ransac(x, y, within), least_squares(x, y):
            assert angle_deg(found, u) < 1e-9, case
        assert angle_deg(by_essential_matrix(x, z, within), u) < 0.5, case
        moved = points[mover] - [0.15, 0.1, 0.1]
        x[mover] = moved / moved[:, 2:]
        x[:, :2] += random.normal(scale=0.1 / 400, size=(n, 2))  # a tenth of a pixel
        assert angle_deg(two_point_ransac(x, y, within), u) < 1, case
    squares = {"x": [5], "y": [5], "half_width": [2], "half_height": [1], "outline": [[]],
               "circles": [1], "rebel_circles": [1]}
    places = np.array([[5.0, 5.5], [5.0, 7.0]])
    assert inside_moving_squares(squares, places).tolist() == [True, False]
    assert not inside_moving_squares({**squares, "rebel_circles": [0]}, places).any()
    print("The directions are as expected.")


def main():
    arguments = argparse.ArgumentParser(description=__doc__,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("suite", nargs="?", type=pathlib.Path, help="kept with --keep all")
    arguments.add_argument("--full", action="store_true", help="all sets of corners and intervals")
    arguments.add_argument("--self-test", action="store_true")
    options = arguments.parse_args()
    if options.self_test:
        return self_test()
    if options.suite is None:
        arguments.error("name the folder of a suite")
    cv2.setNumThreads(1)
    with multiprocessing.Pool(2) as pool:
        runs = pool.map(measure, sorted(options.suite.glob("runs/*/seed*")), 1)
    if not any(runs):
        arguments.error(f"{options.suite} has no runs with pairs")
    report(runs, options.full)


if __name__ == "__main__":
    main()
