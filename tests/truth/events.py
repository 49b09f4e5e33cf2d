"""Events of a dark bar that passes before a bright wall: their numbers and their times."""

import math

import numpy as np

from bench import Camera, around, at_most, linear, scene, still_path

CAMERA = Camera(size_px=(160, 60), focal_px=(210.0, 210.0), centre_px=(79.5, 29.5))
WIDTH_M, DEPTH_M, START_Y_M, SPEED_MPS = (
    0.09,
    1.0,
    -0.25,
    0.2,
)  # of the bar; it moves along world y, to the left
PX_PER_S = CAMERA.focal_px[0] * SPEED_MPS / DEPTH_M
ROW = 30  # all rows see the same; times are compared in this one
DURATION_S = 2.6


def crossing_s(column, outline_y_m):
    """When an outline of the bar that is at outline_y_m at 0 s passes the middle of a column of pixels."""
    y_m = (CAMERA.centre_px[0] - column) / CAMERA.focal_px[0] * DEPTH_M
    return (y_m - outline_y_m) / SPEED_MPS


def half_light_s(times_s, bright, dark, contrast, is_on):
    """When a pixel has the mean of the light of wall and bar: the outline is then in the pixel's middle.

    The i-th OFF event is where the logarithm of the light has fallen by i contrasts; the ON events that
    follow are at the same levels, upwards, the last one where the light is the wall's. The sensor adds
    0.001 to the light; between two events light is taken to change evenly.
    """
    falls = np.arange(len(times_s) - 1, -1, -1) if is_on else np.arange(1, len(times_s) + 1)
    lights = (bright + 0.001) * np.exp(-contrast * falls) - 0.001
    sign = 1 if is_on else -1  # np.interp wants rising values
    return np.interp(sign * (bright + dark) / 2, sign * lights, times_s)


def pass_by(bench, material, contrast, rate_hz):
    """Events (t, x, y, p) and the light of wall and bar, both 0 to 1."""
    # The bar faces its direction of motion: its own x is along the picture's rows. It is so thin that its
    # sides are not seen.
    half_depth_m = 0.0001
    xml = scene(
        '<geom type="box" pos="3 0 1" size=".05 6 6" material="bright"/>',
        bodies=f'<body name="bar" pos="1.5 {START_Y_M} 1"><geom type="box" '
        f'size="{WIDTH_M / 2} {half_depth_m} .6" material="{material}"/></body>',
    )
    frames = round(DURATION_S * rate_hz) + 1
    line = {"from": [DEPTH_M + half_depth_m, START_Y_M], "heading": "90 deg", "speed": SPEED_MPS}
    sequence = bench.generate(
        f"events_{material}_{contrast * 100:.0f}_{rate_hz}_hz",
        xml,
        {
            "frames": frames,
            "ego": still_path(DURATION_S + 1),
            "camera": CAMERA.keys(rate=rate_hz),
            "actors": {"bar": {"body": "bar", "trajectory": {"line": line}}},
            "events": {
                "positive": contrast,
                "negative": contrast,
                "spread": 0,
                "refractory": 0,
                "leak": 0,
                "shot": 0,
            },
        },
        "events",
    )
    pictures = sequence.pictures()
    return sequence.events(), linear(pictures[0])[ROW, 5], linear(pictures[frames // 2])[ROW].min()


def events(bench):
    """As many ON as OFF events where the bar passes wholly, and their times by the bar's true place."""
    # The pixels that see the wall alone for .3 s before and after.
    passed = [
        x
        for x in range(CAMERA.size_px[0])
        if 0.3 < crossing_s(x, START_Y_M + WIDTH_M / 2)
        and crossing_s(x, START_Y_M - WIDTH_M / 2) < DURATION_S - 0.3
    ]
    # Bounds in px, of the mean and of single columns. At 10 Hz pictures are made where the bar has moved by 1
    # px, and the logarithm of light goes straight between them: it is too dark there, which moves outlines
    # outwards by .06 px in the mean and .12 px at worst; the samples of a pixel add a tenth. (With the dark
    # bar, whose contrast is 4 times as large, that is twice as much: its times are not compared.) At 100 Hz
    # the bar moves by .4 px between pictures.
    cases = (
        ("dark", 0.2, 10, None),
        ("dark", 0.35, 10, None),
        ("grey", 0.2, 10, (0.12, 0.3)),
        ("grey", 0.2, 100, (0.04, 0.15)),
    )
    for material, contrast, rate_hz, bounds_px in cases:
        name = f"events, {material} bar, contrast {contrast}, {rate_hz} Hz"
        found, bright, dark = pass_by(bench, material, contrast, rate_hz)
        on, off = (np.zeros(CAMERA.size_px[::-1], int) for _ in range(2))
        for counts, polarity in ((on, 1), (off, 0)):
            of_kind = found[found[:, 3] == polarity]
            np.add.at(counts, (of_kind[:, 2].astype(int), of_kind[:, 1].astype(int)), 1)
        on, off = on[:, passed], off[:, passed]
        yield at_most(
            f"{name}: pixels with unlike numbers of ON and OFF",
            np.mean(on != off),
            0,
            unit="share",
            note=f"{on.size} pixels, {off.sum()} OFF, {on.sum()} ON events; {PX_PER_S:.0f} px/s",
        )
        expected = math.floor(math.log((bright + 0.001) / (dark + 0.001)) / contrast)
        yield around(f"{name}: OFF events of a pixel", off.mean(), expected, 0, unit="")
        if bounds_px is None:
            continue
        of_row = found[found[:, 2] == ROW]
        errors_px = []
        for is_on, outline_y_m in ((False, START_Y_M + WIDTH_M / 2), (True, START_Y_M - WIDTH_M / 2)):
            for x in passed:
                times_s = of_row[(of_row[:, 1] == x) & (of_row[:, 3] == is_on), 0]
                found_s = half_light_s(times_s, bright, dark, contrast, is_on)
                errors_px.append((found_s - crossing_s(x, outline_y_m)) * PX_PER_S)
        errors_px = np.reshape(errors_px, (2, -1))
        yield at_most(
            f"{name}: outline at half light, larger mean of OFF and ON",
            np.abs(errors_px.mean(axis=1)).max(),
            bounds_px[0],
        )
        yield at_most(f"{name}: outline at half light, largest error", np.abs(errors_px).max(), bounds_px[1])
