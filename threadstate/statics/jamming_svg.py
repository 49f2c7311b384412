"""The picture of a jamming diagram, as SVG for light and dark pages."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

from threadstate.numbers import number_text
from threadstate.statics.cone_slice import SliceKind
from threadstate.statics.jamming import Axis, Mode
from threadstate.statics.jamming_document import (
    MOST_NAMED,
    JammingDocument,
    LoadedContactDocument,
    PieceDocument,
    contacts_text,
    piece_text,
)

WIDTH, PLOT_HEIGHT = 760, 460
LEFT, RIGHT, TOP, BOTTOM = 64, 24, 78, 46
ROW_HEIGHT = 20
MOST_ROWS = 12
"""Pieces, the longest, that the legend names."""
LEAST_LETTER_PX = 16.0
"""Shorter pieces have no letter."""
COLOURS = 6
LEAST_STEP_PX = 0.7
"""Vertices of a curve that are nearer to each other are not drawn."""
DASH_PX = 9
MINUS = "\N{MINUS SIGN}"

Point = tuple[float, float]

_NAMES = {
    Axis.FX: "Fx / Fz",
    Axis.FY: "Fy / Fz",
    Axis.MX: "Mx / (r Fz)",
    Axis.MY: "My / (r Fz)",
    Axis.MZ: "Mz / (r Fz)",
}

_STYLE = """
.jamming { color-scheme: light dark; --paper: #ffffff; --ink: #1b1f24; --faint: #57606a; --grid: #e4e8ed;
  --inside: #dbe7f3; --c1: #0b5fa5; --c2: #c2410c; --c3: #16794c; --c4: #7c3aed; --c5: #a16207; --c6: #be185d;
  --c0: #57606a; }
@media (prefers-color-scheme: dark) { .jamming { --paper: #1e2227; --ink: #e7eaee; --faint: #a3adb8; --grid: #333a42;
  --inside: #2a3a4b; --c1: #6cb6f5; --c2: #ff9b63; --c3: #4fd1a5; --c4: #b9a0ff; --c5: #e3bd5b; --c6: #f78fb8;
  --c0: #a3adb8; } }
.jamming text { fill: var(--ink); font: 13px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
.jamming .title { font-size: 16px; font-weight: 600; }
.jamming .soft { fill: var(--faint); }
.jamming .middle { text-anchor: middle; } .jamming .end { text-anchor: end; }
.jamming .halo { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round; }
.jamming .ground { fill: var(--paper); } .jamming .inside { fill: var(--inside); }
.jamming .grid { stroke: var(--grid); } .jamming .axis { stroke: var(--faint); stroke-width: 1.2; }
.jamming .edge { fill: none; stroke-width: 3; stroke-linejoin: round; }
.jamming .load { fill: var(--paper); stroke: var(--ink); stroke-width: 1.8; }
.jamming .letter { font-weight: 600; }
"""


@dataclass(frozen=True, slots=True)
class _View:
    """The part of the plane that is drawn: a range of x and one of y, which fill the plot."""

    low: Point
    high: Point

    def x(self, x: float) -> float:
        """Where a value of x is, in pixels from the left."""
        return LEFT + (x - self.low[0]) / (self.high[0] - self.low[0]) * (WIDTH - LEFT - RIGHT)

    def y(self, y: float) -> float:
        """Where a value of y is, in pixels from the top."""
        return TOP + (self.high[1] - y) / (self.high[1] - self.low[1]) * (PLOT_HEIGHT - TOP - BOTTOM)

    def at(self, point: Sequence[float]) -> Point:
        """Where a point is."""
        return self.x(point[0]), self.y(point[1])


def jamming_svg(document: JammingDocument) -> str:
    """The picture of a jamming diagram: the same document gives the same text."""
    view = _view(document)
    seen = [piece for piece in document["pieces"] if not piece["window"]]
    rows = _named(view, document, seen)
    letters = {piece["first"]: chr(ord("a") + i) for i, piece in enumerate(rows)}
    notes = list(_notes(document, len(seen) - len(rows)))
    height = PLOT_HEIGHT + ROW_HEIGHT * (len(rows) + len(notes)) + 16
    title = (
        f"Jamming diagram: roll {number_text(document['roll'])}°, pitch {number_text(document['pitch'])}°, "
        f"phase {number_text(document['phase'])}°, μ = {number_text(document['mu'])}"
    )
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" class="jamming" viewBox="0 0 {WIDTH} {height}" '
            f'width="{WIDTH}" height="{height}" role="img" aria-label="{escape(title)}">',
            f"<title>{escape(title)}</title>",
            f"<style>{_STYLE}</style>",
            f'<rect class="ground" width="{WIDTH}" height="{height}"/>',
            f'<text class="title" x="{LEFT}" y="28">{escape(title)}</text>',
            f'<text class="soft" x="{LEFT}" y="48">{escape(_subtitle(document))}</text>',
            *_inside(view, document),
            *_axes(view, document),
            *_line(view, document),
            *(line for piece in seen for line in _edge(view, document, piece)),
            *(line for piece in rows for line in _letter(view, document, piece, letters[piece["first"]])),
            *_load_mark(view, document),
            *_legend(document, rows, letters, notes),
            "</svg>",
            "",
        ]
    )


def _named(view: _View, document: JammingDocument, seen: Sequence[PieceDocument]) -> list[PieceDocument]:
    """The pieces that have a letter: the longest, in their order along the boundary."""
    if document["dimension"] != 2:
        return list(seen)
    lengths = {piece["first"]: _length(view, document, piece) for piece in seen}
    longest = sorted(lengths, key=lambda first: -lengths[first])[:MOST_ROWS]
    return [piece for piece in seen if piece["first"] in longest and lengths[piece["first"]] >= LEAST_LETTER_PX]


def _subtitle(document: JammingDocument) -> str:
    texts = {
        SliceKind.EMPTY: "The contacts balance no load of this plane.",
        SliceKind.POINT: "The contacts balance one load of this plane alone.",
        SliceKind.SEGMENT: "The contacts balance the loads on a segment.",
        SliceKind.BOUNDED: "The contacts can balance the loads in the shaded part.",
        SliceKind.UNBOUNDED: "The contacts can balance the loads in the shaded part, which goes on beyond the window.",
        SliceKind.PLANE: "The contacts can balance every load of this plane.",
    }
    if document["kind"] == SliceKind.UNBOUNDED and document["dimension"] == 1:
        return "The contacts balance the loads on a line, which goes on beyond the window."
    return texts[document["kind"]]


def _notes(document: JammingDocument, more: int) -> Iterator[str]:
    if more > 0:
        yield "and a shorter piece" if more == 1 else f"and {more} shorter pieces"
    if document["wedged"]:
        wedged = contacts_text(document["wedged"]).capitalize()
        yield f"{wedged} can wedge: they press against each other without any load."
    if document["penetrating"]:
        yield "The solids overlap in this pose: no forces can be real there."


def _view(document: JammingDocument) -> _View:
    """What is drawn: the boundary and the load, or the window."""
    if document["window"] is not None:
        x, y = document["window"]
        return _View((-x, -y), (x, y))
    points = [[0.0, 0.0], document["load_at"], *document["vertices"]]
    low, high = [], []
    for axis in (0, 1):
        values = [point[axis] for point in points]
        size = max(values) - min(values) or 1.0
        low.append(min(values) - 0.12 * size)
        high.append(max(values) + 0.12 * size)
    return _View((low[0], low[1]), (high[0], high[1]))


def _points(document: JammingDocument, piece: PieceDocument) -> list[list[float]]:
    """The vertices of a piece; a single one at the end of a segment."""
    vertices, first, last = document["vertices"], piece["first"], piece["last"]
    if first < last or document["dimension"] != 2:
        return vertices[first : last + 1]
    return [*vertices[first:], *vertices[: last + 1]]


def _length(view: _View, document: JammingDocument, piece: PieceDocument) -> float:
    places = [view.at(point) for point in _points(document, piece)]
    return sum(math.dist(a, b) for a, b in pairwise(places))


def _path(places: Sequence[Point]) -> str:
    """A path through places but for those that are too near to see."""
    kept = [places[0]]
    kept += [place for place in places[1:-1] if math.dist(place, kept[-1]) >= LEAST_STEP_PX]
    kept += places[-1:] if len(places) > 1 else []
    return "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in kept)


def _inside(view: _View, document: JammingDocument) -> Iterator[str]:
    if document["kind"] == SliceKind.PLANE:
        yield (
            f'<rect class="inside" x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" '
            f'height="{PLOT_HEIGHT - TOP - BOTTOM}"/>'
        )
    elif document["dimension"] == 2 and document["vertices"]:
        yield f'<path class="inside" d="{_path([view.at(point) for point in document["vertices"]])}Z"/>'


def _line(view: _View, document: JammingDocument) -> Iterator[str]:
    if document["dimension"] == 1 and len(document["vertices"]) == 2:
        places = [view.at(point) for point in document["vertices"]]
        yield f'<path class="edge" style="stroke: var(--ink)" d="{_path(places)}"/>'


def _axes(view: _View, document: JammingDocument) -> Iterator[str]:
    """Grid, axes through (0, 0), ticks and names."""
    left, right, top, bottom = LEFT, WIDTH - RIGHT, TOP, PLOT_HEIGHT - BOTTOM
    for value in _ticks(view.low[0], view.high[0]):
        x = view.x(value)
        yield f'<path class="grid" d="M{x:.2f} {top}V{bottom}"/>'
        yield f'<text class="soft middle" x="{x:.2f}" y="{bottom + 18}">{_tick(value)}</text>'
    for value in _ticks(view.low[1], view.high[1]):
        y = view.y(value)
        yield f'<path class="grid" d="M{left} {y:.2f}H{right}"/>'
        yield f'<text class="soft end" x="{left - 8}" y="{y + 4:.2f}">{_tick(value)}</text>'
    yield f'<path class="axis" d="M{left} {view.y(0.0):.2f}H{right}"/>'
    yield f'<path class="axis" d="M{view.x(0.0):.2f} {top}V{bottom}"/>'
    across, up = (_NAMES[axis] for axis in document["axes"])
    yield f'<text class="end" x="{right}" y="{bottom + 36}">{across}</text>'
    yield f'<text x="{left - 52}" y="{top - 10}">{up}</text>'


def _ticks(low: float, high: float) -> list[float]:
    """Round values between two others: four to ten."""
    rough = (high - low) / 8.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough)
    return [step * i for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _tick(value: float) -> str:
    return f"{value:.6g}".replace("-", MINUS)


def _shown(contacts: Sequence[LoadedContactDocument]) -> list[LoadedContactDocument]:
    """The contacts whose colours a piece has: those that slide, or that the bolt tips about; none of too many."""
    sliding = [contact for contact in contacts if contact["mode"] == Mode.SLIDES] or list(contacts)
    return sliding if len(sliding) <= MOST_NAMED else []


def _colour(contact: int) -> str:
    return f"var(--c{(contact - 1) % COLOURS + 1})"


def _edge(view: _View, document: JammingDocument, piece: PieceDocument) -> Iterator[str]:
    """A piece in dashes of the colours of its contacts; a dot at the end of a segment."""
    places = [view.at(point) for point in _points(document, piece)]
    colours = [_colour(contact["contact"]) for contact in _shown(piece["contacts"])] or ["var(--c0)"]
    if len(places) == 1:
        x, y = places[0]
        yield f'<circle cx="{x:.2f}" cy="{y:.2f}" r="5" style="fill: {colours[0]}"/>'
        return
    path = _path(places)
    for i, colour in enumerate(colours):
        dashes = ""
        if len(colours) > 1:
            dashes = f"; stroke-dasharray: {DASH_PX} {DASH_PX * (len(colours) - 1)}; stroke-dashoffset: {-i * DASH_PX}"
        yield f'<path class="edge" style="stroke: {colour}{dashes}" d="{path}"/>'


def _letter(view: _View, document: JammingDocument, piece: PieceDocument, letter: str) -> Iterator[str]:
    """The letter of a piece, outside of it half way along."""
    places = [view.at(point) for point in _points(document, piece)]
    if len(places) == 1:
        (x, y), out = places[0], (0.0, -1.0)
    else:
        half = _length(view, document, piece) / 2.0
        for a, b in pairwise(places):
            step = math.dist(a, b)
            if step >= half and step > 0.0:
                break
            half -= step
        share = half / step
        x, y = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        # Counter-clockwise in the plane the outside is on the right; pixels count downwards.
        out = (-(b[1] - a[1]) / step, (b[0] - a[0]) / step)
    mark = view.at(document["load_at"])
    away = 14.0 if math.dist((x + 14.0 * out[0], y + 14.0 * out[1]), mark) > 16.0 else -14.0
    x = min(max(x + away * out[0], LEFT + 8.0), WIDTH - RIGHT - 8.0)
    y = min(max(y + away * out[1], TOP + 8.0), PLOT_HEIGHT - BOTTOM - 8.0)
    yield f'<text class="letter middle halo" x="{x:.2f}" y="{y + 4.5:.2f}">{letter}</text>'


def _load_mark(view: _View, document: JammingDocument) -> Iterator[str]:
    """Where the load itself is: a pure push at (0, 0)."""
    x, y = view.at(document["load_at"])
    text = "push" if not any(document["load_at"]) else "load"
    yield f'<circle class="load" cx="{x:.2f}" cy="{y:.2f}" r="4.5"/>'
    anchor, shift = ("end", -9.0) if x > WIDTH - RIGHT - 60.0 else ("start", 9.0)
    yield f'<text class="halo" style="text-anchor: {anchor}" x="{x + shift:.2f}" y="{y - 8:.2f}">{text}</text>'


def _legend(
    document: JammingDocument, rows: Sequence[PieceDocument], letters: dict[int, str], notes: Sequence[str]
) -> Iterator[str]:
    y = PLOT_HEIGHT + 10.0
    for piece in rows:
        yield f'<text class="letter" x="{LEFT}" y="{y:.1f}">{letters[piece["first"]]}</text>'
        colours = [_colour(contact["contact"]) for contact in _shown(piece["contacts"])] or ["var(--c0)"]
        width = 36.0 / len(colours)
        for i, colour in enumerate(colours):
            x = LEFT + 18.0 + i * width
            yield f'<rect x="{x:.1f}" y="{y - 6.5:.1f}" width="{width:.1f}" height="4" style="fill: {colour}"/>'
        yield f'<text x="{LEFT + 64}" y="{y:.1f}">{escape(piece_text(document, piece))}</text>'
        y += ROW_HEIGHT
    for note in notes:
        yield f'<text class="soft" x="{LEFT}" y="{y:.1f}">{escape(note)}</text>'
        y += ROW_HEIGHT
