"""The cells of the notebook, one after another in one namespace, as Jupyter runs them."""

import json
import os
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

import lcs

NOTEBOOK = Path(__file__).resolve().parents[2] / "tools" / "python" / "own_detector.ipynb"


class Page(HTMLParser):
    """The texts of a page by the name of their element. Each element that it opens must be closed."""

    def __init__(self, html):
        super().__init__()
        self.open, self.texts, self.links = [], {}, []
        self.feed(html)
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.links += [value for name, value in attrs if name == "href"]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.texts.setdefault(self.open[-1], []).append(data)


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
        self.check_pages(namespace["mine"], namespace["answer"])

    def check_pages(self, mine, answer):
        """Jupyter shows the results as the program prints them, with all rows to unfold."""
        page = Page(mine._repr_html_())
        self.assertIn(mine["table"], page.texts["pre"])
        self.assertIn(f"runs ({len(mine['runs'])})", page.texts["summary"])
        for run in mine["runs"]:
            self.assertIn(run["scenario"], page.texts["td"])
        self.assertEqual(len(page.links), 0, "the files were in a folder that is gone")
        page = Page(answer._repr_html_())
        self.assertIn(answer["text"], page.texts["pre"])
        self.assertIn(f": {answer['verdict']}", page.texts["div"])

    def test_a_page_escapes_names_and_links_files(self):
        page = Page(lcs.Answer(file=NOTEBOOK, name="<b>&", gone=Path("/no/such"), none=None)._repr_html_())
        self.assertEqual(page.links, [str(NOTEBOOK)])
        self.assertIn(": <b>&", page.texts["div"])
        self.assertNotIn("none", page.texts["b"])


if __name__ == "__main__":
    unittest.main()
