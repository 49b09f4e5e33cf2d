"""Checks the folders of the product.

No folder includes, over others, itself; no file includes one of a top folder that it must not know; and each
file is in the namespace of its folder.

Usage: folders_test.py REPOSITORY
"""

import collections
import pathlib
import re
import sys

TOPS = ("scenarios", "filter", "sim", "scenes", "tools")
# What a top folder may include besides itself.
MAY_INCLUDE = {
    "scenarios": set(),
    "filter": set(),
    "sim": {"scenarios"},
    "scenes": {"scenarios", "sim"},
    "tools": {"scenarios", "filter", "sim", "scenes"},
}
# The namespaces of the folders; another folder of tools/ has one of its own name.
NAMESPACES = {
    "scenarios": {"lcs::scenario"},
    "scenarios/input": {"lcs::input", "lcs"},  # `lcs`: fs, the short name of std::filesystem
    "filter": {"lcs"},
    "filter/paper": {"lcs::paper", "lcs"},  # `lcs`: the class for users
    "sim": {"lcs::sim"},
    "sim/scene": {"lcs::sim", "lcs::sim::xml", "lcs::sim::mj"},
    "scenes/worlds": {"lcs::worlds"},
    "tools/lcs": {"lcs::tools"},
}
NAMESPACE = re.compile(r"^namespace (lcs[a-z_:]*) \{", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def includes_in(root):
    """Pairs of files of the product, relative to the root: one that includes, and the included one."""
    files = {path.relative_to(root) for top in TOPS for path in (root / top).rglob("*")
             if path.suffix in (".h", ".cpp", ".inl")}
    for file in sorted(files):
        for name in INCLUDE.findall((root / file).read_text(encoding="utf-8")):
            if (included := pathlib.Path(name)) in files:
                yield file, included


def namespaces_in(root):
    """Pairs of a file of the product, relative to the root, and a namespace that it opens."""
    for top in TOPS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cpp", ".inl"):
                for name in NAMESPACE.findall(path.read_text(encoding="utf-8")):
                    yield path.relative_to(root), name


def strangers_in(namespaces):
    """A line for each file that opens the namespace of another folder."""
    for file, name in namespaces:
        folders = [file.parent, *file.parent.parents]
        own = next((NAMESPACES[str(folder)] for folder in folders if str(folder) in NAMESPACES),
                   {f"lcs::{file.parts[1]}"})
        if name not in own:
            yield f"{file} is in the namespace {name}, not in {' or '.join(sorted(own))}"


def circle_in(arrows):
    """Folders of which each includes the next one, and the last one the first; empty if there are none.

    arrows: for each folder, the folders that it includes.
    """
    done = set()

    def search(folder, path):
        if folder in path:
            return path[path.index(folder):]
        if folder in done:
            return []
        for other in sorted(arrows.get(folder, ())):
            if circle := search(other, path + [folder]):
                return circle
        done.add(folder)
        return []

    for folder in sorted(arrows):
        if circle := search(folder, []):
            return circle
    return []


def faults_in(includes):
    """A line for each forbidden include, and for a circle of folders."""
    faults = []
    examples = collections.defaultdict(dict)
    for file, included in includes:
        top, other = file.parts[0], included.parts[0]
        if top != other and other not in MAY_INCLUDE[top]:
            faults.append(f"{file} includes {included}, but {top}/ must not know {other}/")
        if file.parent != included.parent:
            examples[file.parent].setdefault(included.parent, f"{file} includes {included}")
    if circle := circle_in(examples):
        steps = [examples[one][other] for one, other in zip(circle, circle[1:] + circle[:1])]
        faults.append("these folders form a circle: " + "; ".join(steps))
    return faults


def check_itself():
    """The check finds a circle over three folders, an arrow that runs up, and a file in a foreign namespace."""
    def pairs(*names):
        return [tuple(map(pathlib.Path, pair)) for pair in names]

    circle = pairs(("sim/a/x.h", "sim/b/x.h"), ("sim/b/y.h", "sim/c/x.h"), ("sim/c/y.h", "sim/a/y.h"))
    assert len(faults_in(circle)) == 1 and "circle" in faults_in(circle)[0]
    assert not faults_in(circle[:2])
    assert "must not know" in faults_in(pairs(("scenes/x.h", "tools/app/x.h")))[0]
    path = pathlib.Path("tools/files/x.h")
    assert not list(strangers_in([(path, "lcs::files")])) and list(strangers_in([(path, "lcs::app")]))


def main():
    check_itself()
    includes = list(includes_in(pathlib.Path(sys.argv[1])))
    assert len(includes) > 1000, "too few includes were found to judge by"
    namespaces = list(namespaces_in(pathlib.Path(sys.argv[1])))
    assert len(namespaces) > 400, "too few namespaces were found to judge by"
    faults = faults_in(includes) + list(strangers_in(namespaces))
    print("\n".join(faults) or f"{len(includes)} includes, no circle; {len(namespaces)} namespaces")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
