"""Replays of recordings, for the tests beside this file."""

import json
import shutil
import subprocess
from pathlib import Path


def replay(lcs: str, path: Path, out: Path, *options: str) -> list:
    """The number of corners and their verdicts in each frame of `lcs replay`."""
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([lcs, "replay", path, "--out", out, "--no-video", "--quiet", *options], check=True)
    frames = [json.loads(line) for line in (out / "layers.jsonl").read_text().splitlines()]
    return [(len(frame["corners"]["x"]), frame["corners"]["verdict"]) for frame in frames if "corners" in frame]
