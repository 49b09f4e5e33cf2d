#!/usr/bin/env python3
"""Runs the commands of guides/walkthroughs.md in a clean clone, and writes their times into that page.

    tests/docs/walkthroughs.py [--keep DIR] [--check]

--keep DIR  makes the clone there, where its outputs stay; a temporary folder if not given
--check     leaves the page as it is

The clone has the last commit and the page of the working tree. It uses the MuJoCo that tools/run
downloaded here before. Exits with 1 at the first command that fails, after its output.
"""

import argparse
import datetime
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "tools/docs/guides/walkthroughs.md"
SECTION = re.compile(r"^## (.*?)$(.*?)(?=^## |\Z)", re.M | re.S)
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.M | re.S)
TIMES = re.compile(r"(<!-- times -->\n).*?(<!-- end of times -->)", re.S)


def as_text(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.1f} min"


def run_all(clone):
    """(title, seconds) of each section."""
    environment = {**os.environ, "MPLBACKEND": "Agg"}  # evo draws without a display
    rows = []
    for title, text in SECTION.findall(PAGE.read_text()):
        script = "\n".join(BLOCK.findall(text))
        print(f"## {title}", flush=True)
        start_s = time.monotonic()
        code = subprocess.run(["bash", "-eux", "-c", script], cwd=clone, env=environment, check=False).returncode
        if code:
            sys.exit(f"walkthroughs.py: '{title}' ended with exit code {code}")
        rows.append((title, time.monotonic() - start_s))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path, metavar="DIR")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory() as temporary:
        clone = arguments.keep or Path(temporary) / "clone"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        if (ROOT / ".mujoco").exists():
            shutil.copytree(ROOT / ".mujoco", clone / ".mujoco", symlinks=True)
        rows = run_all(clone)

    table = [f"| walk-through | time on {os.cpu_count()} cores |", "|---|---|"]
    table += [f"| {title} | {as_text(seconds)} |" for title, seconds in rows]
    print("\n".join(table))
    if not arguments.check:
        note = f"\n(Measured on {datetime.date.today()}.)\n\n"
        page = PAGE.read_text()
        PAGE.write_text(TIMES.sub(lambda m: m[1] + "\n" + "\n".join(table) + "\n" + note + m[2], page))


if __name__ == "__main__":
    main()
