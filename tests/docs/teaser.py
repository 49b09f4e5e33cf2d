#!/usr/bin/env python3
"""Writes the moving picture at the head of README.md: teaser.py LCS FILE.webp

The video of `lcs run scenarios/crossing.yaml`, smaller and with fewer frames, below 1 MB."""

import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
from PIL import Image

WIDTH_PX, EVERY, QUALITY = 960, 2, 45


def main(lcs, target):
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([lcs, "run", "crossing", "--out", f"{work}/run", "--quiet"], check=False)
        video = cv2.VideoCapture(f"{work}/run/video.mp4")
        rate = video.get(cv2.CAP_PROP_FPS)
        frames = []
        while (read := video.read())[0]:
            frames.append(read[1])
    shown = []
    for frame in frames[2::EVERY]:
        size = (WIDTH_PX, frame.shape[0] * WIDTH_PX // frame.shape[1])
        small = cv2.resize(frame, size, interpolation=cv2.INTER_AREA)
        shown.append(Image.fromarray(cv2.cvtColor(small, cv2.COLOR_BGR2RGB)))
    shown[0].save(target, save_all=True, append_images=shown[1:], loop=0, quality=QUALITY,
                  method=6, duration=int(1000 * EVERY / rate))  # fmt: skip
    print(f"{len(shown)} frames, {Path(target).stat().st_size} bytes")


if __name__ == "__main__":
    main(*sys.argv[1:3])
