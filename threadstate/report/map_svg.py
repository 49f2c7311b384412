"""Maps over roll and pitch as SVG: the same map gives the same text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from threadstate.report.words import exact

WIDTH, SIDE = 460, 380
LEFT, TOP, BOTTOM = 62, 36, 46
LEGEND_ROW = 24
LEAST_TEXT_PX = 26.0
"""Smaller squares have no text."""
MOST_LABELS = 11
SHADES = 4
"""Shades of a square above the lightest one, which stands for none."""


@dataclass(frozen=True, slots=True)
class Square:
    """An orientation of a map: its shade, 0 for none to 4; a short text; what both mean, in words.

    ``undecided``: something is not known of it, and it is hatched. ``chosen``: it has a border.
    """

    roll_deg: float
    pitch_deg: float
    shade: int
    text: str
    meaning: str
    undecided: bool
    chosen: bool


@dataclass(frozen=True, slots=True)
class TiltMap:
    """A map: squares of every orientation of a grid, whose tilts ascend; ``shades`` says what each shade means."""

    name: str
    title: str
    alternative: str
    tilts_deg: tuple[float, ...]
    squares: tuple[Square, ...]
    shades: tuple[str, ...]


def shade_of(share: float) -> int:
    """The shade of a part of a whole, 0 to 1: 0 for none, else 1 to 4."""
    return min(int(-(-SHADES * share // 1.0)), SHADES)


def map_svg(tilt_map: TiltMap) -> str:
    """A picture of the map, roll across and pitch up."""
    height = TOP + SIDE + BOTTOM + 2 * LEGEND_ROW
    hatch = f"hatch-{tilt_map.name}"
    return "\n".join(
        [
            f'<svg class="map" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{escape(tilt_map.alternative)}">',
            f'<defs><pattern id="{hatch}" width="9" height="9" patternUnits="userSpaceOnUse" '
            'patternTransform="rotate(45)"><path class="hatch" d="M2 0V9"/></pattern></defs>',
            f'<text class="title" x="{LEFT / 2}" y="22">{escape(tilt_map.title)}</text>',
            *(line for square in tilt_map.squares for line in _square(tilt_map, square, hatch)),
            *(_border(tilt_map, square) for square in tilt_map.squares if square.chosen),
            *_axes(tilt_map),
            *_legend(tilt_map, hatch),
            "</svg>",
        ]
    )


def _size(tilt_map: TiltMap) -> float:
    return SIDE / len(tilt_map.tilts_deg)


def _corner(tilt_map: TiltMap, square: Square) -> tuple[float, float]:
    """The upper left corner of a square."""
    size, tilts = _size(tilt_map), tilt_map.tilts_deg
    return LEFT + size * tilts.index(square.roll_deg), TOP + SIDE - size * (tilts.index(square.pitch_deg) + 1)


def _square(tilt_map: TiltMap, square: Square, hatch: str) -> Iterator[str]:
    size, (x, y) = _size(tilt_map), _corner(tilt_map, square)
    place = f'x="{x:.2f}" y="{y:.2f}" width="{size:.2f}" height="{size:.2f}"'
    yield f'<g><title>{escape(square.meaning)}</title><rect class="square shade-{square.shade}" {place}/>'
    if square.undecided:
        yield f'<rect fill="url(#{hatch})" {place}/>'
    if size >= LEAST_TEXT_PX:
        kind = f"ink-{square.shade}{' halo-' + str(square.shade) if square.undecided else ''}"
        yield (
            f'<text class="middle {kind}" x="{x + 0.5 * size:.2f}" y="{y + 0.5 * size + 4.5:.2f}">'
            f"{escape(square.text)}</text>"
        )
    yield "</g>"


def _border(tilt_map: TiltMap, square: Square) -> str:
    size, (x, y) = _size(tilt_map), _corner(tilt_map, square)
    return f'<rect class="chosen" x="{x:.2f}" y="{y:.2f}" width="{size:.2f}" height="{size:.2f}"/>'


def _axes(tilt_map: TiltMap) -> Iterator[str]:
    size, tilts = _size(tilt_map), tilt_map.tilts_deg
    # Every so many tilts has its number, counted from the level one in the middle.
    every = -(-len(tilts) // MOST_LABELS)
    for i, tilt_deg in enumerate(tilts):
        if (i - len(tilts) // 2) % every == 0:
            middle = size * (i + 0.5)
            yield f'<text class="soft middle" x="{LEFT + middle:.2f}" y="{TOP + SIDE + 18}">{exact(tilt_deg)}</text>'
            yield f'<text class="soft end" x="{LEFT - 8}" y="{TOP + SIDE - middle + 4.5:.2f}">{exact(tilt_deg)}</text>'
    x, y = 18, TOP + SIDE / 2
    yield f'<text class="soft middle" x="{LEFT + SIDE / 2}" y="{TOP + SIDE + 38}">roll (deg)</text>'
    yield f'<text class="soft middle" x="{x}" y="{y}" transform="rotate(-90 {x} {y})">pitch (deg)</text>'


def _legend(tilt_map: TiltMap, hatch: str) -> Iterator[str]:
    """The shades that there are with their meanings; below them hatching and border."""
    y = TOP + SIDE + BOTTOM
    left = LEFT / 2
    shades = {square.shade for square in tilt_map.squares}
    width = (WIDTH - left) / len(tilt_map.shades)
    for place, i in enumerate(sorted(shades)):
        yield _swatch(left + place * width, y, f'class="square shade-{i}"', tilt_map.shades[i])
    x, y = left, y + LEGEND_ROW
    if any(square.undecided for square in tilt_map.squares):
        yield _swatch(x, y, f'class="undecided" fill="url(#{hatch})"', "not all is decided")
        x += 0.5 * SIDE
    if any(square.chosen for square in tilt_map.squares):
        yield _swatch(x, y, 'class="chosen"', "the path in detail")


def _swatch(x: float, y: float, look: str, meaning: str) -> str:
    return (
        f'<rect {look} x="{x:.1f}" y="{y}" width="14" height="14"/>'
        f'<text x="{x + 20:.1f}" y="{y + 12}">{escape(meaning)}</text>'
    )
