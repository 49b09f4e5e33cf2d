"""Outlines of dark bars before a bright wall, in linear light: their place, width and smear."""

import math

import numpy as np

from bench import Camera, around, at_most, into, linear, scene, within

BAR_THICKNESS_M = 0.0001  # its sides then are a hundredth of a pixel wide


# Tilted outlines move by 4.2 px in these 60 rows, so that their mean is of all sub-pixel places.
TILT_DEG = 4.0
TILTED_ROWS = np.arange(210, 270)


def bar(x, y, z, width_m, height_m, tilt_deg=0.0):
    """A thin dark box across the line of sight (world x); positive tilt turns it as the camera sees it."""
    half = math.radians(tilt_deg) / 2
    return (
        f'<geom type="box" pos="{x} {y} {z}" quat="{math.cos(half)} {math.sin(half)} 0 0" '
        f'size="{BAR_THICKNESS_M / 2} {width_m / 2} {height_m / 2}" material="dark"/>'
    )


def outlines(camera, T_WC, rows, x, y, width_m):
    """Columns of both outlines, in the rows, of a bar tilted by TILT_DEG whose middle is at z = 1 m."""
    tilt = math.radians(TILT_DEG)
    along = np.array([0, -math.sin(tilt), math.cos(tilt)])
    across = np.array([0, math.cos(tilt), math.sin(tilt)])
    columns_px = []
    # Lines through two points each, of the front and of the back, whose outer ones are seen.
    for side, depth in ((+1, -1), (+1, +1), (-1, -1), (-1, +1)):  # world y is to the left
        middle = np.array([x + depth * BAR_THICKNESS_M / 2, y, 1]) + side * width_m / 2 * across
        (x0, y0), (x1, y1) = camera.project(
            into(np.linalg.inv(T_WC), [middle - 0.5 * along, middle + 0.5 * along])
        )
        columns_px.append(x0 + (rows - y0) * (x1 - x0) / (y1 - y0))
    return np.minimum(*columns_px[:2]), np.maximum(*columns_px[2:])


def darkness(picture, rows, columns, bright, dark):
    """Share of each pixel's light that is missing, 0 (wall) to 1 (bar), for slices of rows and columns."""
    return (bright - linear(picture[rows, columns])) / (bright - dark)


def bars(bench):
    """Width and place of bars of several widths, by the light that they take away."""
    distance_m = 2.0
    camera, rows = Camera(), TILTED_ROWS
    # Widths in m: 6 to 43 px at f = 420 px.
    widths_m = (0.03, 0.053, 0.083, 0.127, 0.203)
    places_m = (0.95, 0.62, 0.25, -0.2, -0.75)
    xml = scene(
        '<geom type="box" pos="3 0 1" size=".05 6 6" material="bright"/>\n'
        + "\n".join(bar(distance_m, y, 1, width, 1.6, TILT_DEG) for y, width in zip(places_m, widths_m))
    )
    path = {"path": [[0, 0, 0, 1, 0, 0, 0], [2, 0, 0.05, 1, 0, 0, 0]]}
    sequence = bench.generate(
        "bars", xml, {"frames": 8, "ego": path, "camera": camera.keys(rate="4 Hz")}, "euroc"
    )
    width_errors, centre_errors, row_errors = [], [], []
    for picture, T_WC in zip(sequence.pictures(), sequence.poses(), strict=True):
        bright = linear(picture[rows, 5]).mean()
        for y, width in zip(places_m, widths_m):
            left, right = outlines(camera, T_WC, rows, distance_m, y, width)
            middle = int(round((left + right).mean() / 2))
            reach = int(math.ceil((right - left).mean() / 2)) + 12
            columns = np.arange(middle - reach, middle + reach + 1)
            inner = [linear(picture[row, int(round(c))]) for row, c in zip(rows, (left + right) / 2)]
            missing = darkness(picture, rows[:, None], columns[None, :], bright, np.mean(inner))
            widths_px = missing.sum(axis=1)
            centres_px = (missing * columns).sum(axis=1) / widths_px
            row_errors.append(widths_px - (right - left))
            width_errors.append(row_errors[-1].mean())
            centre_errors.append((centres_px - (left + right) / 2).mean())
    width_errors, centre_errors = np.array(width_errors), np.array(centre_errors)
    note = f"{len(width_errors)} bars, each the mean of {len(rows)} rows"
    # A blur that acts on codes in place of light takes or adds half a pixel. 8-bit codes of light give each
    # row an error of some .01 px; samples at a fifth of a pixel give single rows .1 px at worst an outline.
    yield within("bar: width in light, mean", width_errors.mean(), 0.05, note=note)
    yield at_most("bar: width in light, largest error of a bar", np.abs(width_errors).max(), 0.05)
    yield at_most("bar: width in light, sigma of single rows", np.concatenate(row_errors).std(), 0.12)
    yield within("bar: centre, mean", centre_errors.mean(), 0.02)
    yield at_most("bar: centre, largest error of a bar", np.abs(centre_errors).max(), 0.05)


def drive_sideways(speed_mps, start_y_m, frames):
    """Scenario keys of a rover that looks along x and drives to its left."""
    return {"frames": frames, "ego": {"start": [0, start_y_m], "direction": "90 deg", "speed": speed_mps}}


def shutter(bench):
    """Rows and exposures of a moving camera: the slope of an upright pole, the ramp of an outline."""
    camera, distance_m, speed_mps = Camera(), 2.0, 1.5
    px_per_m = camera.focal_px[0] / (distance_m - BAR_THICKNESS_M / 2)  # at the front of a bar
    place = dict(position=[0, 0, 1], rate="10 Hz")
    wall = '<geom type="box" pos="3 0 1" size=".05 6 6" material="bright"/>\n'

    shutter_s = 0.04
    pole = scene(wall + bar(distance_m, 0, 1, 0.06, 3))
    sequence = bench.generate(
        "rolling_shutter",
        pole,
        {**drive_sideways(speed_mps, -0.6, 4), "camera": camera.keys(**place, rolling_shutter=shutter_s)},
        "euroc",
    )
    width, height = camera.size_px
    rows = np.arange(height)
    errors, slopes = [], []
    for picture, T_WC in zip(sequence.pictures(), sequence.poses(), strict=True):
        # The true column of the pole in each row, at the time of this row.
        y_m = T_WC[1, 3] + speed_mps * shutter_s * rows / height
        true_px = camera.centre_px[0] + px_per_m * y_m  # the pole is at world y = 0
        columns = np.arange(int(true_px.min()) - 20, int(true_px.max()) + 21)
        columns = columns[(columns >= 0) & (columns < width)]
        bright = linear(picture[:, columns[0]]).mean()
        missing = darkness(picture, rows[:, None], columns[None, :], bright, 0)
        found_px = (missing * columns).sum(axis=1) / missing.sum(axis=1)
        errors.append(found_px - true_px)
        slopes.append(np.polyfit(rows, found_px, 1)[0])
    errors, slopes = np.array(errors), np.array(slopes)
    expected = px_per_m * speed_mps * shutter_s / height
    # Over the 480 rows .0003 px a row are .15 px. A picture is made of drawings between which a point moves
    # by .25 px at most: single rows are off by an eighth of a pixel at worst, beside the samples of a pixel.
    yield around(
        "rolling shutter: slope of a pole",
        slopes.mean(),
        expected,
        0.0003,
        unit="px/row",
        digits=4,
        note=f"{len(slopes)} pictures",
    )
    yield within("rolling shutter: column at the time of its row, mean", errors.mean(), 0.05)
    yield at_most("rolling shutter: the same, sigma", errors.std(), 0.1)
    yield at_most("rolling shutter: the same, largest error", np.abs(errors).max(), 0.35)

    half_plane = scene(wall + bar(distance_m, -1.5, 1, 3, 3, TILT_DEG))
    for exposure_s in (0.02, 0.04):
        sequence = bench.generate(
            f"exposure_{exposure_s * 1000:.0f}_ms",
            half_plane,
            {**drive_sideways(speed_mps, -0.6, 4), "camera": camera.keys(**place, exposure=exposure_s)},
            "euroc",
        )
        lengths, middles = [], []
        for picture, T_WC in zip(sequence.pictures(), sequence.poses(), strict=True):
            edges_px, _ = outlines(camera, T_WC, TILTED_ROWS, distance_m, -1.5, 3)
            for y, edge_px in zip(TILTED_ROWS, edges_px):
                row = linear(picture[y])
                bright, dark = row[int(edge_px) - 40], row[int(edge_px) + 40]
                columns = np.arange(int(edge_px) - 30, int(edge_px) + 31)
                missing = (bright - row[columns]) / (bright - dark)
                # The middle, which the lens's point spread leaves straight.
                ramp = (missing > 0.3) & (missing < 0.7)
                slope, offset = np.polyfit(columns[ramp], missing[ramp], 1)
                lengths.append(1 / slope)
                middles.append((0.5 - offset) / slope - edge_px)
        expected = px_per_m * speed_mps * exposure_s
        name = f"exposure of {exposure_s * 1000:.0f} ms"
        # In each row two to five pixels of the ramp are fitted; by the drawings and by the samples of a pixel
        # each is off by up to .2 px, which the mean of the rows reduces.
        yield around(
            f"{name}: length of the ramp in light",
            1 / np.mean(1 / np.array(lengths)),
            expected,
            0.15,
            note=f"{len(lengths)} rows of 4 pictures",
        )
        yield within(f"{name}: its middle at the frame's time", np.mean(middles), 0.05)
