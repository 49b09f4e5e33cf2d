"""Runs the Python example of the top README.md."""

import contextlib
import io
import re
import unittest
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "README.md"


class Readme(unittest.TestCase):
    def test_its_example_prints_f1(self):
        blocks = re.findall(r"^```python\n(.*?)^```$", README.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
        self.assertEqual(len(blocks), 1)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(blocks[0], str(README), "exec"), {})
        self.assertGreater(float(printed.getvalue()), 0.5)
        self.assertLessEqual(float(printed.getvalue()), 1)


if __name__ == "__main__":
    unittest.main()
