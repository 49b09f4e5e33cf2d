"""to_neutral.py on tables of other units, axes and signs: neutral_test.py"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("SKIPPED: needs numpy")
    sys.exit(77)

SCRIPT = Path(__file__).resolve().parents[3] / "tools/replay/to_neutral.py"
HALF = 0.5**0.5


class Neutral(unittest.TestCase):
    def made(self, name, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            home = Path(folder)
            (home / "in").mkdir()
            for k in (10, 9):
                (home / f"in/{k}.png").write_bytes(b"%d" % k)
            (home / "times.txt").write_text("1403636579.763555584\n1403636579.8\n")
            (home / "table.txt").write_text(text)
            subprocess.run([sys.executable, SCRIPT, home / "out", "--pictures", home / "in", "--times",
                            home / "times.txt", f"--{name}", home / "table.txt", "--camera", "4", "3", "9",
                            "9", "1.5", "1", *options], check=True)  # fmt: skip
            self.assertEqual((home / "out/pictures/000001.png").read_bytes(), b"10")
            self.assertEqual((home / "out/times.csv").read_text().split("\n")[1:3],
                             ["1403636579763555584,000000.png", "1403636579800000000,000001.png"])  # fmt: skip
            lines = (home / f"out/{name}.csv").read_text().split("\n")
        return np.array([[float(x) for x in line.split(",")] for line in lines[1:-1]])

    def test_vehicle_axes_with_w_first(self):
        """A yaw of 90 degrees to the left about z up is one of -90 degrees about y down."""
        rows = self.made("poses", f"t;x;y;z;w;x;y;z\n1500;1;2;3;{HALF};0;0;{HALF}\n", "--poses-unit", "ms",
                         "--poses-columns", *"01235674", "--axes", "ahead", "left", "up")  # fmt: skip
        x, y, z, w = rows[0, 4:]
        R = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # of the camera's axes in the vehicle's
        turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]) @ R
        ahead = [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]
        np.testing.assert_allclose(ahead, turned[:, 2], atol=1e-9)
        np.testing.assert_allclose(rows[0, :4], [1.5e9, 1, 2, 3])

    def test_accelerations_of_ios_in_g(self):
        rows = self.made("imu", "2,180,0,0,0,0,-1\n", "--imu-unit", "us", "--rates", "deg/s", "--forces=-g")
        np.testing.assert_allclose(rows, [[2000, np.pi, 0, 0, 0, 0, 9.80665]])


unittest.main()
