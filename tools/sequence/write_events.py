#!/usr/bin/env python3
"""Writes the events of a generated sequence as DSEC's HDF5: write_events.py ROWS OUT

ROWS has an event a line, `t_ns x y p` in whole numbers, in the order of time. OUT is a new folder, which
gets events.h5. With --version alone it prints the version of h5py. Needs h5py (Debian: python3-h5py).

/events/t has microseconds after /t_offset, rounded down; /ms_to_idx[k] is the number of the first event
that is k ms or more after it.
"""

from __future__ import annotations

import sys
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError:
    print("writing HDF5 needs h5py and numpy; install Debian's python3-h5py, or: "
          f"{sys.executable} -m pip install h5py", file=sys.stderr)  # fmt: skip
    sys.exit(3)

LINES_AT_ONCE = 1_000_000


def write(rows: Path, out: Path) -> None:
    out.mkdir()
    with rows.open() as lines, h5py.File(out / "events.h5", "w") as file:
        kinds = {"t": "u4", "x": "u2", "y": "u2", "p": "u1"}
        columns = {name: file.create_dataset(f"events/{name}", (0,), kind, maxshape=(None,),
                                             chunks=(2**16,), compression="gzip")
                   for name, kind in kinds.items()}  # fmt: skip
        offset_us, firsts, ms = None, [], 0
        while text := lines.readlines(32 * LINES_AT_ONCE):
            table = np.loadtxt(text, dtype=np.int64, ndmin=2)
            t_us = table[:, 0] // 1000
            if offset_us is None:
                offset_us = int(t_us[0])
            t_us -= offset_us
            have = len(columns["t"])
            for name, column in zip(kinds, (t_us, *table[:, 1:].T)):
                columns[name].resize((have + len(column),))
                columns[name][have:] = column
            until_ms = int(t_us[-1]) // 1000
            firsts.append(have + np.searchsorted(t_us, np.arange(ms, until_ms + 1) * 1000))
            ms = max(ms, until_ms + 1)
        file["t_offset"] = np.int64(offset_us or 0)
        file["ms_to_idx"] = np.concatenate(firsts or [np.zeros(1)]).astype("u8")


def main(words: list[str]) -> int:
    if words == ["--version"]:
        print(h5py.__version__, end="")
        return 0
    try:
        write(*map(Path, words))
        return 0
    except Exception as fault:  # of any type: h5py passes its library's exceptions on
        print(f"the events were not written ({type(fault).__name__}: {fault})", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
