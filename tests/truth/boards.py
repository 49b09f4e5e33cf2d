"""Corners of chessboards in pictures against projections of their true places."""

import dataclasses
import math

import cv2
import numpy as np

from bench import Camera, at_most, into, scene, within

COLUMNS, ROWS = 9, 7  # squares of a board
WINDOW_PX = 5  # half the side of the window in which cornerSubPix looks for edges
# The window's half diagonal, a pixel for the gradient, and the spread of an outline by the lens: what
# cornerSubPix looks at is then within the four squares that meet in the corner.
LEAST_SQUARE_PX = 12


@dataclasses.dataclass
class Board:
    """A chessboard: its middle in W, and its attitude. At yaw 0 it faces along -x, towards the camera."""

    middle: tuple
    square_m: float
    roll_deg: float = 0.0  # about the line of sight
    pitch_deg: float = 0.0
    yaw_deg: float = 0.0

    @property
    def T_WB(self):
        """Board coordinates: x right, y up, z out of the front, as the camera sees it."""
        cr, sr = math.cos(math.radians(self.roll_deg)), math.sin(math.radians(self.roll_deg))
        cp, sp = math.cos(math.radians(self.pitch_deg)), math.sin(math.radians(self.pitch_deg))
        cy, sy = math.cos(math.radians(self.yaw_deg)), math.sin(math.radians(self.yaw_deg))
        roll = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
        pitch = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
        yaw = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
        facing = np.array([[0, 0, -1], [-1, 0, 0], [0, 1, 0.0]])  # columns: the board's axes in W
        T = np.eye(4)
        T[:3, :3] = facing @ yaw @ pitch @ roll
        T[:3, 3] = self.middle
        return T

    def grid(self):
        """Places in W of all corners of squares, (ROWS + 1) x (COLUMNS + 1) x 3."""
        x = (np.arange(COLUMNS + 1) - COLUMNS / 2) * self.square_m
        y = (np.arange(ROWS + 1) - ROWS / 2) * self.square_m
        points = np.stack([*np.meshgrid(x, y), np.zeros((ROWS + 1, COLUMNS + 1))], axis=-1)
        return into(self.T_WB, points.reshape(-1, 3)).reshape(points.shape)

    def _geom(self, middle_B, half_sides, material):
        T = self.T_WB
        place = into(T, [middle_B])[0]
        axes = np.concatenate([T[:3, 0], T[:3, 1]])
        text = " ".join(f"{v:.12g}" for v in axes)
        pos = " ".join(f"{v:.12g}" for v in place)
        size = " ".join(f"{v:.12g}" for v in half_sides)
        return f'<geom type="box" pos="{pos}" xyaxes="{text}" size="{size}" material="{material}"/>'

    def tiles(self):
        """Geoms of the board: a box for each square, all fronts in one plane, z = 0 of the board."""
        half, thick = self.square_m / 2, 0.004
        return [
            self._geom(
                [(i - COLUMNS / 2 + 0.5) * self.square_m, (j - ROWS / 2 + 0.5) * self.square_m, -thick],
                [half, half, thick],
                "dark" if (i + j) % 2 else "bright",
            )
            for j in range(ROWS)
            for i in range(COLUMNS)
        ]

    def panel(self, material):
        """One box as large as the board, with its front in the same plane."""
        return self._geom(
            [0, 0, -0.004], [COLUMNS / 2 * self.square_m, ROWS / 2 * self.square_m, 0.004], material
        )


BOARDS = [  # one in each sixth of the picture, 18 px a square if it faced the camera
    Board((2.0, 0.98, 1.53), 0.086, roll_deg=11, pitch_deg=-12, yaw_deg=20),
    Board((2.4, 0.00, 1.65), 0.103, roll_deg=-24, pitch_deg=15, yaw_deg=-8),
    Board((1.8, -0.9, 1.48), 0.077, roll_deg=4, pitch_deg=6, yaw_deg=-26),
    Board((2.6, 1.28, 0.31), 0.111, roll_deg=35, pitch_deg=10, yaw_deg=12),
    Board((1.7, 0.02, 0.55), 0.073, roll_deg=-7, pitch_deg=22, yaw_deg=5),
    Board((3.2, -1.6, 0.15), 0.137, roll_deg=17, pitch_deg=-5, yaw_deg=-15),
]
WALL = '<geom type="box" pos="5 0 1" size=".05 8 6" material="grey"/>'
# The camera goes on slowly and turns a little, so that no two pictures have their corners at the same
# sub-pixel places.
PATH = {
    "path": [
        [0, 0, 0, 1, 0, 0, 0],
        [1, 0.05, 0.11, 1.04, "3 deg", "2 deg", "1 deg"],
        [2, -0.04, -0.07, 0.95, "-2 deg", "-1 deg", "-3 deg"],
    ]
}
RADTAN = (-0.28, 0.07, 0.0002, 0.00002, 0.0)  # of the cameras of EuRoC, rounded
EQUIDISTANT = (0.0035, 0.0007, -0.0021, 0.0002)  # of the cameras of TUM VI, rounded
CAMERAS = {
    "pinhole": Camera(),
    "pinhole, principal point off the middle": Camera(centre_px=(287.3, 261.8)),
    "fx, fy differ": Camera(focal_px=(430.0, 395.0)),
    "radtan": Camera(focal_px=(458.7, 457.3), centre_px=(337.2, 248.4), lens="radtan", distortion=RADTAN),
    "equidistant": Camera(
        focal_px=(460.3, 460.1), centre_px=(317.4, 241.2), lens="equidistant", distortion=EQUIDISTANT
    ),
}


def hidden(points_W, eye_W, own, boards):
    """Which points another board hides: the ray from the eye meets it, or passes it within half a square."""
    found = np.zeros(len(points_W), bool)
    for board in boards:
        if board is own:
            continue
        to_board = np.linalg.inv(board.T_WB)
        a, b = into(to_board, [eye_W])[0], into(to_board, points_W)
        share = np.divide(a[2], a[2] - b[:, 2], out=np.full(len(b), np.inf), where=a[2] != b[:, 2])
        at = a[:2] + share[:, None] * (b[:, :2] - a[:2])
        bound = np.array([COLUMNS + 1, ROWS + 1]) / 2 * board.square_m
        found |= (share > 0) & (share < 1) & np.all(np.abs(at) < bound, axis=1)
    return found


def true_corners(camera, T_WC, boards):
    """Places in px of inner corners to measure, an index for each, and counts of those left out."""
    places, ids, left_out = [], [], {"out of the picture": 0, "small squares": 0, "hidden": 0}
    inner = (ROWS - 1) * (COLUMNS - 1)
    for number, board in enumerate(boards):
        grid = board.grid()
        points_C = into(np.linalg.inv(T_WC), grid.reshape(-1, 3))
        px = camera.project(points_C).reshape(ROWS + 1, COLUMNS + 1, 2)
        middle = px[1:-1, 1:-1]
        # Distance of the neighbouring grid lines: the area of each of the four squares by its longer side.
        smallest = np.full(middle.shape[:2], np.inf)
        for a in (px[1:-1, 2:] - middle, px[1:-1, :-2] - middle):
            for b in (px[2:, 1:-1] - middle, px[:-2, 1:-1] - middle):
                area = np.abs(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
                longer = np.maximum(np.linalg.norm(a, axis=-1), np.linalg.norm(b, axis=-1))
                smallest = np.minimum(smallest, area / longer)
        margin = WINDOW_PX + 2
        width, height = camera.size_px
        inside = np.all(
            (middle >= margin) & (middle <= [width - 1 - margin, height - 1 - margin]), axis=-1
        ).ravel()
        large = (smallest >= LEAST_SQUARE_PX).ravel()
        seen = ~hidden(grid[1:-1, 1:-1].reshape(-1, 3), T_WC[:3, 3], board, boards)
        left_out["out of the picture"] += int(np.sum(~inside))
        left_out["small squares"] += int(np.sum(inside & ~large))
        left_out["hidden"] += int(np.sum(inside & large & ~seen))
        use = inside & large & seen
        places.append(middle.reshape(-1, 2)[use])
        ids.append(number * inner + np.flatnonzero(use))
    return np.concatenate(places), np.concatenate(ids), left_out


def measured_corners(picture, places_px):
    """cornerSubPix, started at the true places."""
    end = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 100, 1e-4)
    start = places_px.astype(np.float32).reshape(-1, 1, 2).copy()
    return cv2.cornerSubPix(picture, start, (WINDOW_PX, WINDOW_PX), (-1, -1), end).reshape(-1, 2)


def all_errors(sequence, camera, boards):
    """Measured less true places, n x 2, of all frames, and a text of what was left out."""
    errors, left_out = [], {}
    for picture, T_WC in zip(sequence.pictures(), sequence.poses(), strict=True):
        places, _, out = true_corners(camera, T_WC, boards)
        errors.append(measured_corners(picture, places) - places)
        left_out = {what: left_out.get(what, 0) + count for what, count in out.items()}
    errors = np.concatenate(errors)
    return errors, f"{len(errors)} corners; left out: " + ", ".join(
        f"{n} {what}" for what, n in left_out.items()
    )


def rows_of(name, errors, note):
    # Bias: conventions that are wrong (a pixel's centre, the principal point, a distortion's sign) give
    # tenths of a pixel or more; the mean of hundreds of corners is known to .01 px. Sigma: a picture whose
    # pixels have the mean light of their area gives some .05 px by its 8 bits and by cornerSubPix itself, one
    # with a single sample a pixel .2 px. Single corners: 5 sigma.
    yield at_most(f"{name}: larger bias of x and y", np.abs(errors.mean(axis=0)).max(), 0.03, note=note)
    yield at_most(f"{name}: larger sigma of x and y", errors.std(axis=0).max(), 0.10)
    yield at_most(f"{name}: largest error", np.abs(errors).max(), 0.5)


def boards(bench):
    """Chessboards made of boxes, by five cameras."""
    xml = scene(WALL + "\n".join(tile for board in BOARDS for tile in board.tiles()))
    for name, camera in CAMERAS.items():
        slug = "boards_" + name.replace(" ", "_").replace(",", "")
        scenario = {"frames": 8, "ego": PATH, "camera": camera.keys(rate="4 Hz")}
        sequence = bench.generate(slug, xml, scenario, "euroc")
        yield from rows_of(f"boards, {name}", *all_errors(sequence, camera, BOARDS))


def texture(bench):
    """One board as a picture on a box, by a pinhole."""
    board = Board((1.6, 0.03, 1.02), 0.1, roll_deg=9, pitch_deg=12, yaw_deg=-14)
    folder = bench.folder / "texture"
    folder.mkdir(parents=True, exist_ok=True)
    square_px = 64  # of the texture; squares end where its pixels end
    i, j = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    cv2.imwrite(
        str(folder / "board.png"), np.kron(np.where((i + j) % 2, 70, 230), np.ones((square_px, square_px)))
    )
    xml = scene(
        WALL + board.panel("board"),
        '<texture name="board" type="2d" file="board.png"/>'
        '<material name="board" texture="board" specular="0" shininess="0"/>',
    )
    camera = Camera()
    scenario = {"frames": 8, "ego": PATH, "camera": camera.keys(rate="4 Hz")}
    sequence = bench.generate("texture", xml, scenario, "euroc")
    yield from rows_of("board as a texture", *all_errors(sequence, camera, [board]))


def stereo(bench):
    """The disparity of corners in the two pictures of a rig."""
    xml = scene(WALL + "\n".join(tile for board in BOARDS for tile in board.tiles()))
    camera, base_m = Camera(), 0.12
    cameras = {
        "left": camera.keys(position=[0, base_m / 2, 0], rate="4 Hz"),
        "right": camera.keys(position=[0, -base_m / 2, 0], rate="4 Hz"),
    }
    sequence = bench.generate("stereo", xml, {"frames": 8, "ego": PATH, "cameras": cameras}, "euroc")
    errors, heights = [], []
    frames = zip(
        sequence.pictures(0), sequence.pictures(1), sequence.poses(0), sequence.poses(1), strict=True
    )
    for left, right, T_WL, T_WR in frames:
        (in_left, ids_left, _), (in_right, ids_right, _) = (
            true_corners(camera, T, BOARDS) for T in (T_WL, T_WR)
        )
        _, at_left, at_right = np.intersect1d(ids_left, ids_right, return_indices=True)
        found_left = measured_corners(left, in_left[at_left])
        found_right = measured_corners(right, in_right[at_right])
        points_W = np.concatenate([board.grid()[1:-1, 1:-1].reshape(-1, 3) for board in BOARDS])
        depth_m = into(np.linalg.inv(T_WL), points_W[ids_left[at_left]])[:, 2]
        disparity_px = found_left[:, 0] - found_right[:, 0]
        errors.append(disparity_px - camera.focal_px[0] * base_m / depth_m)
        heights.append(found_left[:, 1] - found_right[:, 1])
    errors, heights = np.concatenate(errors), np.concatenate(heights)
    # The errors of two corners: sigma is 1.4 times that of one, a bias of both cameras cancels.
    yield within(
        "stereo: disparity less f B / Z, mean", errors.mean(), 0.03, note=f"{len(errors)} corners in both"
    )
    yield at_most("stereo: disparity less f B / Z, sigma", errors.std(), 0.12)
    yield within("stereo: difference of rows, mean", heights.mean(), 0.03)
    yield at_most("stereo: difference of rows, sigma", heights.std(), 0.12)
