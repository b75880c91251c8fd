"""Results in a notebook: tables and pictures. Every text is escaped: it comes from lessons that anybody may have written."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from html import escape

#: Rows of a table that are displayed.
_MOST_ROWS = 50


def plain(value: object) -> str:
    """A value as text."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def text(value: object) -> str:
    """A value as escaped text."""
    return escape(plain(value), quote=True)


def heading(title: str, *more: str) -> str:
    """A line with a title, and what is less important."""
    small = "".join(f" <small>{text(one)}</small>" for one in more if one)
    return f"<p><strong>{text(title)}</strong>{small}</p>"


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table, without the rows after the first fifty."""
    every = [list(row) for row in rows]
    if not every:
        return ""
    head = "".join(f"<th>{text(one)}</th>" for one in heads)
    body = "".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>" for row in every[:_MOST_ROWS])
    left = f"<p><small>and {len(every) - _MOST_ROWS} more</small></p>" if len(every) > _MOST_ROWS else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{left}"


def picture(svg: str, what: str) -> str:
    """A plot as an image, in which nothing can run and whose ids meet no others."""
    encoded = base64.b64encode(svg.encode()).decode()
    return f'<img alt="{text(what)}" src="data:image/svg+xml;base64,{encoded}" style="max-width: 100%">'
