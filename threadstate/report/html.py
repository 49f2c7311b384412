"""Parts of a page of HTML. Every text is plain and is escaped here."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from html import escape

SHORT = 16
"""A table of no more rows stays on one sheet of paper."""


def paragraph(text: str, kind: str = "") -> str:
    """A paragraph."""
    return f"<p{_class(kind)}>{escape(text)}</p>"


def items(texts: Sequence[str]) -> str:
    """A list."""
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in texts)}</ul>"


def code_block(text: str, name: str) -> str:
    """Lines of a file or of a shell, in a box that scrolls."""
    return f'<pre tabindex="0" role="region" aria-label="{escape(name)}"><code>{escape(text)}</code></pre>'


def section(name: str, heading: str, parts: Sequence[str]) -> str:
    """A section with its heading."""
    head = f'<section id="{name}" aria-labelledby="{name}-heading"><h2 id="{name}-heading">{escape(heading)}</h2>'
    return "\n".join([head, *parts, "</section>"])


def table(
    caption: str,
    headings: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    heads: int = 1,
    words: Collection[int] = (),
    sentences: Collection[int] = (),
) -> str:
    """A table in a box that scrolls.

    Args:
        caption: what it shows.
        headings: of its columns.
        rows: texts, as many as there are columns.
        heads: so many first columns name the row.
        words: the numbers of columns, from 0, that hold words; all that are not named hold numbers.
        sentences: those of columns that hold more than a word or two, and are wider.
    """
    kinds = ["" if i in words else "sentence" if i in sentences else "number" for i in range(len(headings))]
    size = " short" if len(rows) <= SHORT else ""
    lines = [
        f'<div class="scroll{size}" tabindex="0" role="region" aria-label="{escape(caption)}"><table>',
        f"<caption><span>{escape(caption)}</span></caption>",
        "<thead><tr>"
        + "".join(
            f'<th scope="col"{_class(kind)}>{escape(one)}</th>' for one, kind in zip(headings, kinds, strict=True)
        )
        + "</tr></thead>",
        "<tbody>",
    ]
    for row in rows:
        cells = [
            f'<th scope="row"{_class(kind)}>{escape(text)}</th>'
            if i < heads
            else f"<td{_class(kind)}>{escape(text)}</td>"
            for i, (text, kind) in enumerate(zip(row, kinds, strict=True))
        ]
        lines.append(f"<tr>{''.join(cells)}</tr>")
    return "\n".join([*lines, "</tbody></table></div>"])


def figure(svg: str, caption: str) -> str:
    """A picture with its caption."""
    return f"<figure>\n{svg}\n<figcaption>{escape(caption)}</figcaption>\n</figure>"


def figures(parts: Sequence[str]) -> str:
    """Figures beside each other, as many as there is room for."""
    return "\n".join(['<div class="figures">', *parts, "</div>"])


def _class(kind: str) -> str:
    return f' class="{kind}"' if kind else ""
