"""The README's blocks, one after another in one namespace, as a user would paste them."""

import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "tools" / "python" / "README.md"


class Readme(unittest.TestCase):
    def test_runs_block_by_block(self):
        text = README.read_text(encoding="utf-8")
        blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE))
        self.assertGreaterEqual(len(blocks), 7)
        namespace = {}
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as elsewhere:
            os.chdir(elsewhere)  # outside the project
            try:
                for block in blocks:
                    lines_before = text[: block.start(1)].count("\n")
                    code = compile("\n" * lines_before + block[1], str(README), "exec")
                    exec(code, namespace)
                    sys.stdout.flush()
            finally:
                os.chdir(here)


if __name__ == "__main__":
    unittest.main()
