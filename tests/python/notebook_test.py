"""The cells of the notebook, one after another in one namespace, as Jupyter runs them."""

import json
import os
import tempfile
import unittest
from pathlib import Path

NOTEBOOK = Path(__file__).resolve().parents[2] / "tools" / "python" / "own_detector.ipynb"


class Notebook(unittest.TestCase):
    def test_its_cells_run_in_order(self):
        cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
        namespace = {}
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as elsewhere:
            os.chdir(elsewhere)  # outside the project
            try:
                for number, cell in enumerate(cells):
                    self.assertFalse(cell.get("outputs"), "the notebook is kept without outputs")
                    if cell["cell_type"] == "code":
                        code = compile("".join(cell["source"]), f"cell {number}", "exec")
                        exec(code, namespace)
            finally:
                os.chdir(here)
        detectors = {run["detector"] for run in namespace["mine"]["runs"]}
        self.assertEqual(detectors, {"mine", "klt"})
        self.assertEqual({run["outcome"] for run in namespace["mine"]["runs"]}, {"passed"})
        self.assertTrue(namespace["answer"]["means"])


if __name__ == "__main__":
    unittest.main()
