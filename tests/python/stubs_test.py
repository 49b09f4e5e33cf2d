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
MYPY = "mypy==1.18.2"
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
    # Left out: members that only Python's enum module uses, names with _, and __new__, which raises.
    text = re.sub(
        r"(?:    @\w+\n)?    def (?:_(?!_)\w+_|__format__|__new__)\(.*?(?=^    (?:@|def )|^\S|\Z)",
        "",
        text,
        flags=re.DOTALL | re.MULTILINE,
    )
    text = re.sub(r"^ *_(?!_)\w+(?::| =) .*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^from \. import _core\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^    ([A-Z_0-9]+): typing\.ClassVar\[\w+\]$", r"    \1 = ...", text, flags=re.MULTILINE)
    text = text.replace("-> dict:", "-> dict[str, typing.Any]:").replace("__all__: list ", "__all__: list[str] ")
    text = text.replace("(dict):", "(dict[str, typing.Any]):")
    text = text.replace("-> list:", "-> list[numpy.typing.NDArray[numpy.float64]]:")
    # The first line of a docstring names the type of an array's elements.
    text = re.sub(
        r'-> numpy\.ndarray(:\n +"""\n[^\n]*?\b(?:float64|float32|int32|uint8|bool)\b)',
        lambda m: f"-> numpy.typing.NDArray[numpy.{m[1].split()[-1].replace('bool', 'bool_')}]{m[1]}",
        text,
    )
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

    def test_a_type_checker_reads_it(self):
        program = """
import numpy
import lcs
from numpy.typing import NDArray

def rebels(path: str) -> list[NDArray[numpy.bool_]]:
    scenario = lcs.Scenario(path, set={"frames": 3}, seed=1)
    watch = lcs.Filter(scenario)
    return [watch.step(f.corners, f.motion, f.signatures, picture=f.grey).rebels for f in lcs.simulate(scenario)]

label: lcs.Label = lcs.Label.REBEL
"""
        wrong = "lcs.Filter(lcs.Scenario('a.yaml')).step([[1, 2]], 'no motion')\n"
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-m", "venv", folder], check=True)
            pip = [f"{folder}/bin/pip", "install", "--quiet", "--retries", "1", MYPY, "numpy"]
            if subprocess.run(pip).returncode != 0:
                skip(f"pip does not fetch {MYPY}")
            for text, expected in ((program, "Success"), (program + wrong, 'expected "Motion"')):
                file = Path(folder) / "program.py"
                file.write_text(text)
                environment = {**os.environ, "MYPYPATH": str(STUB.parents[1])}
                command = [f"{folder}/bin/mypy", "--strict", "--cache-dir", f"{folder}/cache", str(file)]
                said = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True).stdout
                self.assertIn(expected, said)


if __name__ == "__main__":
    if not os.environ.get("LCS_PYBIND11", "").startswith(PYBIND11):
        skip(f"the stub is of pybind11 {PYBIND11}x")
    unittest.main()
