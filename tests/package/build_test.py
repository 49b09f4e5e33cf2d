"""Tests tools/package/build without a build: what it refuses, says and leaves behind.

Usage: build_test.py SOURCE VERSION
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, VERSION = pathlib.Path(sys.argv[1]), sys.argv[2]
FILES = [
    "CMakeLists.txt",
    "CMakePresets.json",
    "tools/setup.sh",
    "tools/package/build",
    "tools/package/CHANGELOG.md",
    "tools/package/Containerfile",
    "tools/package/requirements.txt",
]
CPACK = """#!/bin/sh
generator=$2
while [ "$1" != -B ]; do shift; done
mkdir -p "$2"
[ "$generator" = DEB ] && file=lcs.deb || file=lcs.tar.gz
echo new > "$2/$file"
[ "$generator" != "$LCS_FAILS" ]
"""
# Says of each package that it is installed.
INSTALLED = """#!/bin/sh
shift 2
for package; do printf '%s=installed ' "$package"; done
"""


class Build(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name) / "lcs"
        for name in FILES:
            (self.top / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.top / name)
        self.out = self.top / "made"
        # Stand-ins: nothing is installed or built, and cpack makes one file.
        self.programs = pathlib.Path(folder.name) / "programs"
        self.programs.mkdir()
        for name, text in {"cmake": "#!/bin/sh\n", "cpack": CPACK, "dpkg-query": INSTALLED}.items():
            (self.programs / name).write_text(text)
            (self.programs / name).chmod(0o755)

    def git(self, *arguments):
        who = ["-c", "user.name=test", "-c", "user.email=test@localhost"]
        subprocess.run(["git", "-C", self.top, *who, *arguments], check=True, capture_output=True)

    def commit(self, message):
        self.git("commit", "--quiet", "--allow-empty", "--message", message)

    def build(self, *parts, fails=""):
        environment = {name: value for name, value in os.environ.items() if name[:4] != "GIT_"}
        environment |= {
            "PATH": f"{self.programs}:{os.environ['PATH']}",
            "LCS_MUJOCO_ROOT": "/",
            "LCS_FAILS": fails,
        }
        return subprocess.run(
            [self.top / "tools/package/build", "--out", self.out, *parts],
            env=environment,
            capture_output=True,
            text=True,
        )

    def made(self):
        return sorted(path.name for path in self.out.iterdir()) if self.out.exists() else []

    def test_first_release_of_changelog_is_version(self):
        changelog = (SOURCE / "tools/package/CHANGELOG.md").read_text()
        self.assertEqual(re.findall(r"^## (\d\S*)", changelog, re.M)[0], VERSION)

    def test_other_version_is_refused(self):
        changelog = self.top / "tools/package/CHANGELOG.md"
        changelog.write_text(f"# Changes\n\n## 99.0.1\n\n* New.\n\n## {VERSION}\n")
        done = self.build("deb")
        self.assertEqual(done.returncode, 2)
        self.assertIn("99.0.1", done.stderr)
        self.assertIn(VERSION, done.stderr)
        self.assertEqual(self.made(), [])

    def test_unreleased_changes_are_allowed(self):
        changelog = self.top / "tools/package/CHANGELOG.md"
        changelog.write_text(f"# Changes\n\n## Unreleased\n\n* New.\n\n## {VERSION}\n")
        self.assertEqual(self.build("deb").returncode, 0)

    def test_unknown_part_is_refused(self):
        done = self.build("rpm")
        self.assertEqual(done.returncode, 2)
        self.assertIn("rpm", done.stderr)

    def test_tag_is_said(self):
        self.git("init", "--quiet")
        self.commit("first")
        self.assertIn(f"there is no tag v{VERSION}", self.build("deb").stderr)
        self.git("tag", f"v{VERSION}")
        self.assertIn(f"this commit has the tag v{VERSION}", self.build("deb").stderr)
        self.commit("second")
        self.assertIn("this commit has no tag", self.build("deb").stderr)

    def test_packages_lie_beside_container_and_nothing_else(self):
        done = self.build("deb")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.made(), ["Containerfile", "lcs.deb"])

    def test_failure_leaves_earlier_files(self):
        self.assertEqual(self.build("deb").returncode, 0)
        (self.out / "lcs.deb").write_text("earlier")
        self.assertEqual(self.build("deb", "archive", fails="TGZ").returncode, 2)
        self.assertEqual(self.made(), ["Containerfile", "lcs.deb"])
        self.assertEqual((self.out / "lcs.deb").read_text(), "earlier")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
