"""Each relative link of the Markdown files leads to a file, and each anchor to a heading."""

import os
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^ *(```|~~~).*?^ *\1", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\((?![a-z]+:)([^)#\s]*)(?:#([^)\s]*))?\)")
HEADING = re.compile(r"^#+ +(.*?)\s*$", re.MULTILINE)


def documents():
    for folder, folders, files in os.walk(ROOT):
        if Path(folder) == ROOT:
            folders[:] = [name for name in folders if not name.startswith((".", "build")) and name != "out"]
        yield from (Path(folder) / name for name in files if name.endswith(".md"))


def text_of(document):
    return FENCE.sub("", document.read_text(encoding="utf-8"))


def anchors_of(document):
    """GitHub's anchors: lower case, words joined by dashes, a number behind a repeated one."""
    anchors = set()
    for heading in HEADING.findall(text_of(document)):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        count = sum(known == anchor or re.fullmatch(re.escape(anchor) + r"-\d+", known) is not None for known in anchors)
        anchors.add(f"{anchor}-{count}" if count else anchor)
    return anchors


class Links(unittest.TestCase):
    def test_lead_somewhere(self):
        links = 0
        for document in documents():
            for path, anchor in LINK.findall(text_of(document)):
                links += 1
                target = (document.parent / path).resolve() if path else document
                name = f"{document.relative_to(ROOT)}: {path}#{anchor}"
                with self.subTest(name):
                    self.assertTrue(target.exists(), "no such file")
                    if anchor:
                        readme = target / "README.md" if target.is_dir() else target
                        self.assertIn(anchor, anchors_of(readme))
        self.assertGreater(links, 100)


if __name__ == "__main__":
    unittest.main()
