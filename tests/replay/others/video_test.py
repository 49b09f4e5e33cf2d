#!/usr/bin/env python3
"""video_test.py LCS WORK: an MP4 with B-frames and irregular times, written by PyAV, is replayed with
each picture at its own time, and with the lens of a camchain that PyYAML writes."""

import json
import shutil
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import yaml

LCS, WORK = sys.argv[1], Path(sys.argv[2])
TIMES_MS = [0, 33, 67, 100, 133, 400, 700, 1000, 1033, 1067, 1100, 1134]  # slow in the dark
SIZE = (320, 240)


def picture(k: int) -> np.ndarray:
    """Blocks of random grey levels, moved by 3 px a picture."""
    blocks = np.random.default_rng(1).integers(0, 255, (40, 60), np.uint8)
    whole = np.kron(blocks, np.ones((8, 8), np.uint8))
    return np.repeat(whole[: SIZE[1], 3 * k : 3 * k + SIZE[0], None], 3, axis=2)


def write_video(file: Path) -> None:
    with av.open(str(file), "w") as video:
        stream = video.add_stream("libx264", rate=30)
        stream.width, stream.height = SIZE
        stream.pix_fmt, stream.time_base = "yuv420p", Fraction(1, 1000)
        stream.codec_context.time_base = Fraction(1, 1000)
        stream.options = {"bf": "3", "crf": "15"}
        for k, t_ms in enumerate(TIMES_MS):
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture(k)), format="bgr24")
            frame.pts, frame.time_base = t_ms, Fraction(1, 1000)
            video.mux(stream.encode(frame))
        video.mux(stream.encode())


def main() -> None:
    WORK.mkdir(parents=True, exist_ok=True)
    video, chain, out = WORK / "phone.mp4", WORK / "camchain.yaml", WORK / "out-video"
    write_video(video)
    chain.write_text(yaml.safe_dump({"cam0": {
        "camera_model": "pinhole", "intrinsics": [300.0, 300.0, 159.5, 119.5],
        "distortion_model": "radtan", "distortion_coeffs": [-0.1, 0.01, 0.0, 0.0],
        "resolution": list(SIZE), "T_cam_imu": np.eye(4).tolist()}}))  # fmt: skip
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([LCS, "replay", video, "--calibration", chain, "--speed", "0", "--out", out,
                    "--no-video", "--quiet"], check=True)  # fmt: skip
    lines = [json.loads(line) for line in (out / "layers.jsonl").read_text().splitlines()]
    times = [round(frame["t_ns"] / 1e6) for frame in lines if "t_ns" in frame]
    assert times == TIMES_MS, times
    camera = json.loads((out / "camera.json").read_text())
    assert camera["focal_px"] == 300, camera


main()
