"""What Jupyter shows of the result of a command."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any


def html_of(name: str, value: Any) -> str:
    """HTML of an entry; "" for one without a value."""
    if value is None or value in ("", [], {}):
        return ""
    if isinstance(value, str) and "\n" in value:
        return f'<pre style="font-family: monospace">{escape(value)}</pre>'
    if isinstance(value, dict):
        inside = "".join(html_of(key, one) for key, one in value.items())
    elif isinstance(value, list) and isinstance(value[0], dict):
        inside = _table_of(value)
    else:
        return f"<div><b>{escape(name)}</b>: {_text_of(value)}</div>"
    return f"<details><summary>{escape(name)} ({len(value)})</summary>{inside}</details>"


def _text_of(value: Any) -> str:
    """A value in one line; the path of a file or folder that is there as a link."""
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_text_of, value))
    if value is None:
        return "–"
    text = f"{value:.4g}" if isinstance(value, float) else escape(str(value))
    is_there = isinstance(value, Path) and value.exists()
    return f'<a href="{text}">{text}</a>' if is_there else text


def _table_of(rows: list[dict[str, Any]]) -> str:
    """A table of the columns that have plain values."""
    is_plain = lambda name: not any(isinstance(row[name], (dict, list)) for row in rows)
    names = list(filter(is_plain, rows[0]))
    lines = [[escape(name) for name in names]]
    lines += [[_text_of(row[name]) for name in names] for row in rows]
    cells = ("</td><td>".join(line) for line in lines)
    return "<table>" + "".join(f"<tr><td>{line}</td></tr>" for line in cells) + "</table>"
