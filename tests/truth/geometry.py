"""Depth, flow, masks and boxes against rays and closed forms."""

import ctypes
import json
import math

import cv2
import numpy as np

from bench import Camera, at_most, into, scene, within
from boards import EQUIDISTANT, RADTAN

HALF_QUANTUM_M = 0.5 / 256  # of a depth in KITTI's PNG


class Rays:
    """Rays that MuJoCo itself casts into a scene file; lcs only names the library."""

    def __init__(self, library, scene_file):
        self.mj = ctypes.CDLL(library)
        pointer, number = ctypes.c_void_p, ctypes.c_double
        for name, result, arguments in (
            ("mj_loadXML", pointer, [ctypes.c_char_p, pointer, ctypes.c_char_p, ctypes.c_int]),
            ("mj_makeData", pointer, [pointer]),
            ("mj_forward", None, [pointer, pointer]),
            ("mj_name2id", ctypes.c_int, [pointer, ctypes.c_int, ctypes.c_char_p]),
            # model, data, start, direction, groups, flag: static geoms too, excluded body, geom, normal
            (
                "mj_ray",
                number,
                [
                    pointer,
                    pointer,
                    ctypes.POINTER(number),
                    ctypes.POINTER(number),
                    pointer,
                    ctypes.c_ubyte,
                    ctypes.c_int,
                    ctypes.POINTER(ctypes.c_int),
                    pointer,
                ],
            ),
        ):
            function = getattr(self.mj, name)
            function.restype, function.argtypes = result, arguments
        error = ctypes.create_string_buffer(1000)
        self.model = self.mj.mj_loadXML(str(scene_file).encode(), None, error, len(error))
        if not self.model:
            raise RuntimeError(f"MuJoCo does not load {scene_file}: {error.value.decode()}")
        self.data = self.mj.mj_makeData(self.model)
        self.mj.mj_forward(self.model, self.data)

    def geom(self, name):
        """The number of a geom; 5 is mjOBJ_GEOM."""
        return self.mj.mj_name2id(self.model, 5, name.encode())

    def cast(self, start, directions):
        """Shares of the directions at which they hit something (-1: nothing), and numbers of the geoms."""
        triple, hit = ctypes.c_double * 3, ctypes.c_int()
        found = []
        for direction in directions:
            share = self.mj.mj_ray(
                self.model,
                self.data,
                triple(*start),
                triple(*direction),
                None,
                1,
                -1,
                ctypes.byref(hit),
                None,
            )
            found.append((share, hit.value))
        shares, geoms = zip(*found)
        return np.array(shares), np.array(geoms)


SHAPES = """
    <geom name="wall" type="box" pos="6 0 1" euler="0 0 17" size=".05 9 6" material="bright"/>
    <geom name="floor" type="plane" pos="0 0 -.2" size="20 20 .1" material="grey"/>"""
OBJECTS = """
    <body name="crate" pos="2.5 .7 .6" euler="10 20 30">
      <geom name="crate" type="box" size=".3 .2 .25" material="dark"/></body>
    <body name="ball" pos="2.2 -.5 1.3">
      <geom name="ball" type="sphere" size=".3" material="grey"/></body>
    <body name="egg" pos="3 .1 1.6" euler="30 0 40">
      <geom name="egg" type="ellipsoid" size=".2 .4 .3" material="dark"/></body>
    <body name="pill" pos="3 -1.2 .6" euler="50 10 0">
      <geom name="pill" type="capsule" size=".15 .4" material="dark"/></body>
    <body name="post" pos="3.2 -.3 .4" euler="0 5 0">
      <geom name="post" type="cylinder" size=".25 .5" material="bright"/></body>"""
OBJECT_NAMES = ("crate", "ball", "egg", "pill", "post")
LENSES = {
    "pinhole": Camera(size_px=(480, 360), focal_px=(310.0, 310.0), centre_px=(239.5, 179.5)),
    "radtan": Camera(
        size_px=(480, 360),
        focal_px=(330.7, 329.3),
        centre_px=(246.2, 175.4),
        lens="radtan",
        distortion=RADTAN,
    ),
    "equidistant": Camera(
        size_px=(480, 360),
        focal_px=(290.3, 290.1),
        centre_px=(236.4, 182.2),
        lens="equidistant",
        distortion=EQUIDISTANT,
    ),
}
LOOK = {"path": [[0, 0, 0, 1, 0, 0, 0], [2, 0.4, 0.2, 1.1, "4 deg", "3 deg", "-5 deg"]]}


def masks_of(path):
    """Numbers of objects in DAVIS's indexed PNG: OpenCV reads colours, which the palette has in order."""
    data = path.read_bytes()
    at = data.index(b"PLTE")
    size = int.from_bytes(data[at - 4 : at], "big")
    palette = np.frombuffer(data[at + 4 : at + 4 + size], np.uint8).reshape(-1, 3)
    number_of = np.zeros(1 << 24, int)
    weights = np.array([1 << 16, 1 << 8, 1])  # red, green, blue; OpenCV's order is the other one
    # The first of equal colours counts: unused entries at the end of a palette may repeat one.
    number_of[(palette.astype(int) @ weights)[::-1]] = np.arange(len(palette))[::-1]
    return number_of[cv2.imread(str(path), cv2.IMREAD_COLOR).astype(int) @ weights[::-1]]


def depth(bench):
    """Depth and masks of round and flat shapes against MuJoCo's rays, by three lenses."""
    for lens, camera in LENSES.items():
        slug = f"depth_{lens}"
        sequence = bench.generate(
            slug,
            scene(SHAPES, bodies=OBJECTS),
            {"frames": 2, "ego": LOOK, "camera": camera.keys(rate="1 Hz")},
            "euroc,depth,davis",
        )
        rays = Rays(bench.mujoco(), bench.folder / slug / "scene.xml")
        errors_m, other, pixels = [], 0, 0
        numbers = {rays.geom(name): i + 1 for i, name in enumerate(OBJECT_NAMES)}
        for k, T_WC in enumerate(sequence.poses()):
            depths_m = sequence.depths_m(k)
            masks = masks_of(next(sequence.folder.glob(f"davis/Annotations/480p/*/{k:05}.png")))
            width, height = camera.size_px
            x, y = (values.ravel() for values in np.meshgrid(np.arange(2, width, 3), np.arange(2, height, 3)))
            # Directions with z = 1 in C: the share that mj_ray gives is the depth.
            found_m, geoms = rays.cast(T_WC[:3, 3], camera.rays(np.column_stack([x, y])) @ T_WC[:3, :3].T)
            found_m = np.where(found_m < 0, 0, found_m)  # nothing is hit: 0 in the file
            errors_m.append(depths_m[y, x] - found_m)
            other += np.sum(masks[y, x] != [numbers.get(geom, 0) for geom in geoms])
            pixels += len(x)
        errors_m = np.concatenate(errors_m)
        # The file rounds to 1/256 m: an error of 1.95 mm at most, 0 in the mean (the wall is
        # turned, so that its depths are of many steps of the file). Pixels at outlines may
        # see the other surface. Round shapes are drawn as polyhedra, which lie up to some mm inside.
        name = f"depth, {lens}"
        yield within(
            f"{name}: median error", np.median(errors_m) * 1e3, 0.5, unit="mm", note=f"{pixels} rays"
        )
        yield at_most(f"{name}: 95th percentile", np.percentile(np.abs(errors_m), 95) * 1e3, 2.5, unit="mm")
        yield at_most(
            f"{name}: pixels off by 5 cm and more", np.mean(np.abs(errors_m) > 0.05), 0.005, unit="share"
        )
        yield at_most(f"{name}: pixels of another object than the ray's", other / pixels, 0.005, unit="share")


def box_hit(start, directions, T_WB, half_sides):
    """Shares of the directions (n x 3) at which rays from a point enter a box; infinite: they miss it."""
    to_box = np.linalg.inv(T_WB)
    a, d = into(to_box, [start])[0], directions @ to_box[:3, :3].T
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (-half_sides - a) / d, (half_sides - a) / d
    enter, leave = np.minimum(first, second).max(axis=1), np.maximum(first, second).min(axis=1)
    return np.where((enter < leave) & (enter > 0), enter, np.inf)


def pose(place, yaw):
    T = np.eye(4)
    T[:2, :2] = [[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]]
    T[:3, 3] = place
    return T


WALL_POSE, WALL_HALF = pose((5, 0, 1), math.radians(12)), np.array([0.05, 8, 6])
MOVER_START, MOVER_YAW, MOVER_MPS = np.array([2.4, -0.7, 1.0]), math.radians(80), 0.4
MOVER_HALF = np.array([0.25, 0.2, 0.3])
RATE_HZ = 5
MOVING_SCENE = scene(
    '<geom type="box" pos="5 0 1" euler="0 0 12" size=".05 8 6" material="bright"/>',
    bodies=f'<body name="mover" pos="1 0 {MOVER_START[2]}">'
    '<geom type="box" size=".25 .2 .3" material="dark"/></body>'
    '<body name="near" pos="1.6 .5 .8"><geom type="box" size=".05 .1 .5" material="grey"/></body>',
)
MOVER = {
    "mover": {
        "body": "mover",
        "class": "car",
        "trajectory": {
            "line": {
                "from": MOVER_START[:2].tolist(),
                "heading": f"{math.degrees(MOVER_YAW)} deg",
                "speed": MOVER_MPS,
            }
        },
    }
}


def mover_pose(t_s):
    """The moving box at a time: it goes where it faces."""
    ahead = np.array([math.cos(MOVER_YAW), math.sin(MOVER_YAW), 0])
    return pose(MOVER_START + MOVER_MPS * t_s * ahead, MOVER_YAW)


def first_hits(start, directions, t_s):
    """Shares at which rays hit wall, mover or near box, and which is the first (0, 1, 2; -1: none)."""
    hits = np.array(
        [
            box_hit(start, directions, WALL_POSE, WALL_HALF),
            box_hit(start, directions, mover_pose(t_s), MOVER_HALF),
            box_hit(start, directions, pose((1.6, 0.5, 0.8), 0), np.array([0.05, 0.1, 0.5])),
        ]
    )
    return hits.min(axis=0), np.where(np.isinf(hits.min(axis=0)), -1, hits.argmin(axis=0))


def flow(bench):
    """Flow of a wall, a still box and a moving box against closed form, by three lenses."""
    for lens, camera in LENSES.items():
        sequence = bench.generate(
            f"flow_{lens}",
            MOVING_SCENE,
            {"frames": 5, "ego": LOOK, "camera": camera.keys(rate=f"{RATE_HZ} Hz"), "actors": MOVER},
            "euroc,flow",
        )
        width, height = camera.size_px
        grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).reshape(-1, 2)
        poses, stamps_s = sequence.poses(), sequence.stamps_s()
        still, moving, coded, wrong_flags, pixels = [], [], [], 0, 0
        for k in range(len(poses) - 1):
            directions = camera.rays(grid) @ poses[k][:3, :3].T
            depths, which = first_hits(poses[k][:3, 3], directions, stamps_s[k])
            points_W = poses[k][:3, 3] + np.where(which >= 0, depths, 1)[:, None] * directions
            motion = mover_pose(stamps_s[k + 1]) @ np.linalg.inv(mover_pose(stamps_s[k]))
            goals_W = np.where((which == 1)[:, None], into(motion, points_W), points_W)
            goals_C = into(np.linalg.inv(poses[k + 1]), goals_W)
            goals_px = camera.project(goals_C)
            # Pixels beside another surface are left out: the program's may be of that one.
            labels = which.reshape(height, width).astype(np.uint8)
            core = (cv2.erode(labels, np.ones((3, 3))) == cv2.dilate(labels, np.ones((3, 3)))).ravel()
            core &= which >= 0
            errors = np.linalg.norm(sequence.flow_px(k).reshape(-1, 2) - (goals_px - grid), axis=1)
            still.append(errors[core & (which != 1)])
            moving.append(errors[core & (which == 1)])
            kitti, valid = (values.reshape(-1, *values.shape[2:]) for values in sequence.kitti_flow_px(k))
            coded.append(np.abs(kitti - (goals_px - grid))[core & valid].max(axis=1))
            # What is seen again: the ray to the goal meets nothing before it, and the goal is in the picture.
            # Within half a pixel of the picture's edge both answers are right.
            to_goal = goals_W - poses[k + 1][:3, 3]
            nearest, _ = first_hits(poses[k + 1][:3, 3], to_goal, stamps_s[k + 1])
            margin_px = np.minimum(goals_px, [width - 1, height - 1] - goals_px).min(axis=1)
            clear = core & ~((margin_px > -0.5) & (margin_px < 0))
            wrong_flags += np.sum(clear & (valid != ((margin_px >= 0) & (nearest > 0.999))))
            pixels += clear.sum()
        still, moving, coded = (np.concatenate(parts) for parts in (still, moving, coded))
        name = f"flow, {lens}"
        # Flat surfaces are drawn exactly, and a .flo has the 24 bits of a float: some 1e-5 px. Depths of 24
        # bits give some 1e-4 px. KITTI's file rounds to 1/64 px. A flag may be wrong where a goal is at an
        # outline.
        yield at_most(
            f"{name}: .flo, what stands still, 99.9 %",
            np.percentile(still, 99.9),
            0.005,
            note=f"{len(still)} pixels",
        )
        yield at_most(
            f"{name}: .flo, the moving box, 99.9 %",
            np.percentile(moving, 99.9),
            0.005,
            note=f"{len(moving)} pixels",
        )
        yield at_most(f"{name}: KITTI, 99.9 %", np.percentile(coded, 99.9), 0.005 + 0.5 / 64)
        yield at_most(
            f"{name}: KITTI, wrong flags of what is seen again", wrong_flags / pixels, 0.005, unit="share"
        )


def mask_of_runs(segmentation):
    """COCO's runs: pixels column by column, alternately outside and inside."""
    height, width = segmentation["size"]
    counts = segmentation["counts"]
    inside = np.arange(len(counts)) % 2 == 1
    return np.repeat(inside, counts).reshape(width, height).T


def masks(bench):
    """Masks and boxes of objects: COCO against DAVIS and MOT, and the moving box against its projection."""
    camera = LENSES["pinhole"]
    sequence = bench.generate(
        "masks",
        MOVING_SCENE,
        {"frames": 8, "ego": LOOK, "camera": camera.keys(rate=f"{RATE_HZ} Hz"), "actors": MOVER},
        "euroc,coco,davis,mot",
    )
    coco = json.loads((sequence.folder / "coco/annotations.json").read_text())
    mot = np.loadtxt(next(sequence.folder.glob("mot/*/gt/gt.txt")), delimiter=",", ndmin=2)
    names = {c["id"]: c["name"] for c in coco["categories"]}
    other_pixels = other_boxes = other_mot = other_rays = count = 0
    off_px = []
    for k, T_WC in enumerate(sequence.poses()):
        davis = masks_of(next(sequence.folder.glob(f"davis/Annotations/480p/*/{k:05}.png")))
        mine = [a for a in coco["annotations"] if a["image_id"] == k + 1]
        seen = set(np.unique(davis)) - {0, 254}
        other_boxes += len(seen ^ {a["track_id"] for a in mine})
        for a in mine:
            mask = mask_of_runs(a["segmentation"])
            other_pixels += np.sum(mask != (davis == a["track_id"]))
            y, x = np.nonzero(mask)
            box = [x.min(), y.min(), x.max() - x.min() + 1, y.max() - y.min() + 1]
            other_boxes += box != a["bbox"] or a["area"] != len(x)
            same = mot[(mot[:, 0] == k + 1) & (mot[:, 1] == a["track_id"])]
            other_mot += not (len(same) == 1 and np.array_equal(same[0, 2:6], np.add(box, [1, 1, 0, 0])))
            count += 1
            if names[a["category_id"]] != "car":
                continue
            width, height = camera.size_px
            grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).reshape(-1, 2)
            _, which = first_hits(T_WC[:3, 3], camera.rays(grid) @ T_WC[:3, :3].T, sequence.stamps_s()[k])
            other_rays += np.sum((which == 1).reshape(height, width) != mask)
            # The box round the middles of pixels within the projection of the eight corners.
            signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
            corners_W = into(mover_pose(sequence.stamps_s()[k]), signs * MOVER_HALF)
            px = camera.project(into(np.linalg.inv(T_WC), corners_W))
            low, high = np.ceil(px.min(axis=0)), np.floor(px.max(axis=0))
            off_px.append(np.abs(np.concatenate([low, high - low + 1]) - a["bbox"]).max())
    yield at_most(
        "masks: pixels in which COCO and DAVIS differ", other_pixels, 0, unit="", note=f"{count} masks"
    )
    yield at_most("masks: COCO's boxes and areas unlike those of their masks", other_boxes, 0, unit="")
    yield at_most("masks: MOT's boxes unlike COCO's + 1", other_mot, 0, unit="")
    # A pixel's middle may lie on an outline, to the 24 bits of a float.
    yield at_most(
        "masks: pixels of the moving box unlike those by rays", other_rays, 2 * len(off_px), unit=""
    )
    # A corner of the box that no pixel's middle meets: its last row or column may lack a pixel.
    yield at_most(
        "masks: box of the moving box against its projection, largest difference",
        max(off_px),
        1,
        note=f"{len(off_px)} boxes",
    )
