"""Gathers the pages of the documentation site from the whole repository, for mkdocs.

The Markdown files are used where they are. A file that they link to becomes a page of its own with its text; a folder
becomes a list of its files. The page keys.md is made from the scenarios' JSON Schema.
"""

import json
import posixpath
import re
import subprocess
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
PICTURES = (".jpg", ".png", ".svg", ".webp")
LANGUAGES = {".h": "cpp", ".cpp": "cpp", ".py": "python", ".pyi": "python", ".sh": "bash", ".xml": "xml", ".yaml": "yaml",
             ".json": "json", ".txt": "text"}
# [text](target), [text](target#anchor)
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)(#[^)\s]*)?\)")


def tracked():
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                            check=True, capture_output=True, text=True)
    return sorted(name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file())


def target_of(page, link):
    """The path of a link's target in the repository."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), link))


def page_of(path):
    """The page that shows a file or folder of the repository."""
    if (ROOT / path).is_dir():
        readme = f"{path}/README.md"
        return readme if (ROOT / readme).is_file() else f"{path}/index.md"
    return path if path.endswith(".md") or path.endswith(PICTURES) else path + ".md"


def text_of(path):
    """Markdown that shows a file or folder of the repository."""
    if (ROOT / path).is_dir():
        inside = sorted(name for name in tracked() if posixpath.dirname(name) == path)
        return f"# {path}/\n\n" + "".join(f"- [{Path(name).name}]({Path(name).name})\n" for name in inside)
    if path.endswith(".ipynb"):
        return notebook(path)
    name = LANGUAGES.get(Path(path).suffix, "text")
    return f"# {path}\n\n~~~~~~~~{name}\n{(ROOT / path).read_text()}\n~~~~~~~~\n"


def notebook(path):
    """The cells of a notebook, which is kept without outputs."""
    cells = json.loads((ROOT / path).read_text())["cells"]
    texts = [(cell["cell_type"], "".join(cell["source"])) for cell in cells]
    shown = [text if kind == "markdown" else f"~~~~~~~~python\n{text}\n~~~~~~~~" for kind, text in texts]
    return "\n\n".join([*shown, f"As a notebook: `{path}`.\n"])


def rows(properties, prefix=""):
    """Table rows of the keys of a scenario's section, and of the keys inside these."""
    text = ""
    for key, value in properties.items():
        words = value.get("description", "").replace("|", "\\|")
        if "enum" in value:
            words += ". One of " + ", ".join(f"`{word}`" for word in value["enum"])
        text += f"| `{prefix}{key}` | {words} |\n"
        text += rows(value.get("properties", {}), f"{prefix}{key}.")
        text += rows(value.get("items", {}).get("properties", {}), f"{prefix}{key}[].")
    return text


def keys():
    """Tables of all keys of a scenario, from its JSON Schema."""
    schema = json.loads((ROOT / "scenarios/scenario.schema.json").read_text())
    text = "# Keys of a scenario\n\nEditors show these from the [schema](scenarios/scenario.schema.json).\n"
    head = "\n| key | is |\n|---|---|\n"
    text += head + rows({key: {"description": value.get("description", "")} for key, value in schema["properties"].items()})
    for key, value in schema["properties"].items():
        for part in (value, value.get("items", {}), value.get("additionalProperties")):
            if isinstance(part, dict) and part.get("properties"):
                text += f"\n## {key}\n" + head + rows(part["properties"])
    return text


def on_files(files, config):
    for file in list(files):
        if file.src_uri.endswith(".md"):
            files.remove(file)  # the guides are gathered below, under their paths in the repository
    waiting = [name for name in tracked() if name.endswith(".md")]
    for name in waiting:
        files.append(File.generated(config, name, abs_src_path=str(ROOT / name)))
    while waiting:
        page = waiting.pop()
        made = files.get_file_from_path(page)
        for match in LINK.finditer(made.content_string):
            path = target_of(page, match[1])
            shown = page_of(path)
            if not (ROOT / path).exists() or files.get_file_from_path(shown):
                continue  # mkdocs reports a dead link itself
            if path.endswith(PICTURES):
                files.append(File.generated(config, path, abs_src_path=str(ROOT / path)))
            else:
                files.append(File.generated(config, shown, content=text_of(path)))
                if (ROOT / path).is_dir():
                    waiting.append(shown)
    files.append(File.generated(config, "keys.md", content=keys()))
    files.append(File.generated(config, "cpp/index.html", content=""))  # Doxygen replaces it
    files.append(File.generated(config, "python.md", content="# The Python module\n\n::: lcs\n"))
    for name in ("site.css", "site.js"):
        files.append(File.generated(config, name, abs_src_path=str(ROOT / "tools/docs" / name)))
    # Debian's package libjs-katex, so that a reader's browser asks no other host
    katex = Path("/usr/share/javascript/katex")
    for path in [katex / "katex.min.css", katex / "katex.min.js", *sorted((katex / "fonts").glob("*.woff2"))]:
        files.append(File.generated(config, "katex/" + path.relative_to(katex).as_posix(), abs_src_path=str(path)))
    return files


def on_page_markdown(markdown, page, config, files):
    if page.file.src_uri == "tools/docs/guides/glossary.md":
        page.meta["search"] = {"boost": 4}  # the search lists it before the reference

    def link(match):
        path = target_of(page.file.src_uri, match[1])
        shown = page_of(path)
        if shown == path:
            return match[0]
        return f"]({posixpath.relpath(shown, posixpath.dirname(page.file.src_uri) or '.')}{match[2] or ''})"

    return LINK.sub(link, markdown)
