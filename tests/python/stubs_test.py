"""The stub is what pybind11-stubgen makes of the package. LCS_WRITE_DOCUMENTS=1 writes it anew.

LCS_PYBIND11 is the version that the package is built with: others word signatures differently.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

STUB = Path(__file__).resolve().parents[2] / "tools" / "python" / "lcs" / "__init__.pyi"
STUBGEN = "pybind11-stubgen==3.0.0"
PYBIND11 = "2.10."  # Debian 12


def skip(why):
    print("SKIPPED:", why)
    sys.exit(77)


def generated():
    with tempfile.TemporaryDirectory() as folder:
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--retries", "1"]
        if subprocess.run([*pip, "--target", f"{folder}/stubgen", STUBGEN]).returncode != 0:
            skip(f"pip does not fetch {STUBGEN}")
        path = os.pathsep.join([f"{folder}/stubgen", os.environ["PYTHONPATH"]])
        subprocess.run(
            [sys.executable, "-m", "pybind11_stubgen", "-o", folder, "lcs"],
            env={**os.environ, "PYTHONPATH": path},
            check=True,
        )
        text = (Path(folder) / "lcs" / "__init__.pyi").read_text(encoding="utf-8")
    # Calling __new__ raises, and names with _ are not of the interface.
    text = re.sub(r"    @staticmethod\n    def __new__\(type,.*?\n        \"\"\"\n.*?\"\"\"\n", "", text, flags=re.DOTALL)
    text = re.sub(r"^_(?!_)\w+: .*\n", "", text, flags=re.MULTILINE)
    text = text.replace(
        "import typing\n",
        "from numpy.typing import ArrayLike as _ArrayLike\n"
        "import typing\n"
        "from typing import Optional as _Optional, Union as _Union\n",
        1,
    )
    text = text.replace("-> os.PathLike", "-> pathlib.Path").replace("[os.PathLike]", "[pathlib.Path]")
    text = text.replace(": os.PathLike", ": str | os.PathLike[str]")
    text = text.replace("SCENARIOS: pathlib.PosixPath", "SCENARIOS: pathlib.Path")
    text = re.sub(r"^(__version__: str) = .*", r"\1", text, flags=re.MULTILINE)
    return re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE)


class Stubs(unittest.TestCase):
    def test_the_stub_is_current(self):
        text = generated()
        compile(text, STUB.name, "exec")
        if os.environ.get("LCS_WRITE_DOCUMENTS"):
            STUB.write_text(text, encoding="utf-8")
        self.assertEqual(STUB.read_text(encoding="utf-8"), text)


if __name__ == "__main__":
    if not os.environ.get("LCS_PYBIND11", "").startswith(PYBIND11):
        skip(f"the stub is of pybind11 {PYBIND11}x")
    unittest.main()
