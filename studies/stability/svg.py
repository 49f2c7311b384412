"""A few elements of SVG, as text."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

INK, FAINT = "#222222", "#767676"
FONT = "Helvetica, Arial, 'Liberation Sans', sans-serif"


def text(x: float, y: float, words: str, *, size: float = 12.0, anchor: str = "start", colour: str = INK) -> str:
    """Words at a point; ``anchor`` is start, middle or end."""
    return (
        f'<text x="{x:g}" y="{y:g}" font-size="{size:g}" text-anchor="{anchor}" fill="{colour}">{escape(words)}</text>'
    )


def box(x: float, y: float, width: float, height: float, fill: str, stroke: str = "none") -> str:
    """A rectangle."""
    return f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" fill="{fill}" stroke="{stroke}"/>'


def line(x: float, y: float, to_x: float, to_y: float, stroke: str = FAINT) -> str:
    """A thin line."""
    return f'<path d="M{x:g},{y:g}L{to_x:g},{to_y:g}" stroke="{stroke}" fill="none"/>'


def runs(colour: str, thickness: float, parts: Iterable[tuple[float, float, float]]) -> str:
    """Horizontal bars of one colour: from x along a length, with their middle at y."""
    path = "".join(f"M{x:g},{y:g}h{length:g}" for x, y, length in parts)
    return f'<path d="{path}" stroke="{colour}" stroke-width="{thickness:g}" fill="none" shape-rendering="crispEdges"/>'


def document(width: float, height: float, title: str, description: str, elements: Iterable[str]) -> str:
    """The whole picture on white."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
        f'height="{height:g}" font-family="{escape(FONT)}" role="img">'
    )
    body = [
        f"<title>{escape(title)}</title>",
        f"<desc>{escape(description)}</desc>",
        box(0, 0, width, height, "#ffffff"),
    ]
    return "\n".join([head, *body, *elements, "</svg>"]) + "\n"
