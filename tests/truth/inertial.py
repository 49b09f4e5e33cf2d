"""Readings of a noise-free IMU against the true states that are written beside them."""

import sys

import cv2
import numpy as np

from bench import around, at_most, quaternion_to_matrix, scene

GRAVITY_W = np.array([0, 0, -9.81])  # m/s^2
WALL = '<geom type="box" pos="9 0 1" size=".05 6 6" material="grey"/>'
# A path that turns about all axes and goes in all directions.
PATH = {
    "path": [
        [0, 0, 0, 1, 0, 0, 0],
        [1, 0.6, 0.3, 1.3, "12 deg", "-8 deg", "20 deg"],
        [2, 1.0, -0.2, 1.1, "-15 deg", "10 deg", "-10 deg"],
        [3, 1.7, 0.4, 0.8, "9 deg", "14 deg", "25 deg"],
        [4, 2.0, 0.0, 1.2, "-5 deg", "-12 deg", "5 deg"],
        [5, 2.2, 0.1, 1.0, 0, 0, 0],
    ]
}
DRIVE = {
    "speed": "0.8 m/s",
    "yaw_rate": "25 deg/s",
    "phases": [
        {"at": 1.5, "yaw_rate": "-40 deg/s"},
        {"at": 3, "acceleration": "0.3 m/s^2", "direction": "30 deg"},
    ],
}
# The IMU off the rover's origin and turned: a lever arm, and readings in axes of its own.
TURNED = {"position": [0.15, -0.1, 0.3], "rotation": ["20 deg", "-10 deg", "75 deg"]}


def turn(rotation_vector):
    return cv2.Rodrigues(np.asarray(rotation_vector, float))[0]


def rotation_vector(R):
    """The inverse of turn; cv2 loses digits of small turns, which the antisymmetric part has."""
    a = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    sine = np.linalg.norm(a)
    angle = np.arctan2(sine, (np.trace(R) - 1) / 2)
    return a * (angle / sine if sine > 1e-12 else 1)


def integrated(times_s, gyro, accel, start, is_mean):
    """Attitudes, velocities and places from a true start (R, v, p) on.

    is_mean: a reading is the mean of the period that ends with it; otherwise it is of its instant, and the
    mean of two is taken.
    """
    R, v, p = (np.array(x, float) for x in start)
    states = [(R, v, p)]
    for k in range(1, len(times_s)):
        dt = times_s[k] - times_s[k - 1]
        w = gyro[k] if is_mean else (gyro[k] + gyro[k - 1]) / 2
        a = accel[k] if is_mean else (accel[k] + accel[k - 1]) / 2
        a_W = R @ turn(w * dt / 2) @ a + GRAVITY_W
        p = p + v * dt + a_W * dt * dt / 2
        v = v + a_W * dt
        R = R @ turn(w * dt)
        states.append((R, v, p))
    return states


def true_states(sequence):
    times_s, places, quaternions, velocities = sequence.states()
    return times_s, [quaternion_to_matrix(q) for q in quaternions], velocities, places


def integration_rows(name, sequence, is_mean, bounds):
    """Rows of the largest differences between integrated readings and the truth.

    bounds: of the attitude in rad, the velocity in m/s, the place in m.
    """
    times_s, gyro, accel = sequence.imu()
    true_times_s, R, v, p = true_states(sequence)
    if not np.array_equal(times_s, true_times_s):
        raise RuntimeError(f"{name}: readings and states have different times")
    found = integrated(times_s, gyro, accel, (R[0], v[0], p[0]), is_mean)
    turns_rad = [np.linalg.norm(rotation_vector(R[k].T @ state[0])) for k, state in enumerate(found)]
    off_mps = [np.linalg.norm(state[1] - v[k]) for k, state in enumerate(found)]
    off_m = [np.linalg.norm(state[2] - p[k]) for k, state in enumerate(found)]
    note = f"{len(times_s)} readings in {times_s[-1]:.1f} s"
    yield at_most(f"{name}: attitude", max(turns_rad) * 1e6, bounds[0] * 1e6, unit="urad", note=note)
    yield at_most(f"{name}: velocity", max(off_mps) * 1e3, bounds[1] * 1e3, unit="mm/s")
    yield at_most(f"{name}: place", max(off_m) * 1e3, bounds[2] * 1e3, unit="mm")


def shift_s(times_s, gyro, R):
    """The time, from a reading's stamp, at which the true angular rate is the reading: by least squares.

    Between two stamps the mean rate is the log of the turn by the time; it is the rate in the middle but for
    terms of dt^2. Cubic interpolation of four of them gives the rate at a stamp, differences its slope.
    """
    dt = times_s[1] - times_s[0]
    middle = np.array([rotation_vector(R[k].T @ R[k + 1]) / dt for k in range(len(R) - 1)])
    rate = (9 * (middle[1:-2] + middle[2:-1]) - middle[:-3] - middle[3:]) / 16  # at stamps 2 to n - 3
    slope = (middle[2:-1] - middle[1:-2]) / dt
    readings = gyro[2:-2]
    return np.sum((readings - rate) * slope) / np.sum(slope**2)


def sequence_of(bench, slug, ego, **imu):
    """5 s of an IMU of 200 Hz without noise."""
    return bench.generate(
        slug,
        scene(WALL, extent_m=12),
        {
            "duration": 5,
            "ego": ego,
            "camera": {"size": [64, 48], "rate": "2 Hz"},
            "imu": {"preset": "ideal", "rate": "200 Hz", **imu},
        },
        "euroc",
    )


def time_of_rate(name, sequence, expected_ms):
    times_s, gyro, _ = sequence.imu()
    # The path's rate is smooth: the estimate is right to some us. An estimator of the clocks' shift is
    # thought good if it finds .1 ms.
    return around(name, shift_s(times_s, gyro, true_states(sequence)[1]) * 1e3, expected_ms, 0.1, unit="ms")


def imu(bench):
    """Readings that are means of the period before their stamps: integration, gravity, and their time."""
    # Such means integrate exactly but for the place, which takes the acceleration within a period as even:
    # where a holonomic rover jumps to a new speed, within a period, that is a part of the jump by 5 ms.
    bounds = (1e-9, 1e-6, 5e-3)
    path = sequence_of(bench, "imu_path", PATH)
    yield from integration_rows("IMU, a path: integrated", path, True, bounds)
    drive = sequence_of(bench, "imu_drive", DRIVE, **TURNED)
    yield from integration_rows(
        "IMU, a turning drive, IMU turned and off the middle: integrated", drive, True, bounds
    )
    half_period_ms = 2.5
    yield time_of_rate("IMU, means: time of the angular rate from the stamp", path, -half_period_ms)
    still = sequence_of(bench, "imu_still", {}, **TURNED)
    _, gyro, accel = still.imu()
    _, R, _, _ = true_states(still)
    yield at_most(
        "IMU at rest, turned: acceleration less 9.81 m/s^2 up",
        np.abs([R_WS @ a + GRAVITY_W for R_WS, a in zip(R, accel)]).max(),
        1e-9,
        unit="m/s^2",
    )
    yield at_most("IMU at rest: angular rate", np.abs(gyro).max(), 1e-9, unit="rad/s")


def imu_samples(bench):
    """Readings of the instants of their stamps (imu.reading: sample): integration, and their time."""
    if not bench.knows("imu.reading"):
        print("truth: imu-samples: not tested, as the program has no key imu.reading", file=sys.stderr)
        return
    sequence = sequence_of(bench, "imu_samples", PATH, reading="sample")
    # Samples are joined by straight lines. What these leave out is dt^2 / 12 times the change of the slope:
    # some 1e-5 rad in 5 s, which turn gravity by 1e-4 m/s^2. Readings that are half a period late are 7 cm
    # off.
    yield from integration_rows(
        "IMU, samples, a path: integrated by trapezia", sequence, False, (1e-4, 2e-3, 5e-3)
    )
    yield time_of_rate("IMU, samples: time of the angular rate from the stamp", sequence, 0)
