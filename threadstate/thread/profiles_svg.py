"""The picture of a pair's profiles with the play between them, as SVG for light and dark pages.

An axial section: the axis runs to the right, below the picture. The axes coincide, and the bolt is in phase, midway in
its axial play. Pairs below each other have the same scale of thread pitches.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from threadstate.thread.catalogue import source_of
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits, play_of
from threadstate.thread.profile import Profile
from threadstate.units import LengthUnit, conversion_factor

WIDTH = 780
PITCH_PX = 340.0
"""Length of a thread pitch in the picture."""
START, END = -0.5, 1.0
"""The section in thread pitches: a ridge of the bolt, the grooves beside it, and half a flank beyond each."""
LEFT = (WIDTH - (END - START) * PITCH_PX) / 2.0
TOP, BETWEEN, MARGIN = 68.0, 44.0, 22.0
BODY = 0.22
"""Thread pitches of solid that are drawn beyond the roots."""
ARROW_PX = 26.0
MOST_CHARACTERS = 80
"""Of a designation as a heading; the picture's title has all of it."""
HALF_A_PIXEL = 0.5 / PITCH_PX
UNITS = {LengthUnit.INCH: "inches", LengthUnit.MILLIMETRE: "millimetres"}
DECIMALS = {LengthUnit.INCH: 5, LengthUnit.MILLIMETRE: 4}

_STYLE = """
.profiles { color-scheme: light dark; --paper: #ffffff; --ink: #1b1f24; --faint: #57606a; --bolt: #cfe0f1;
  --bolt-edge: #0b5fa5; --nut: #f3e3cd; --nut-edge: #a8590b; }
@media (prefers-color-scheme: dark) { .profiles { --paper: #1e2227; --ink: #e7eaee; --faint: #a3adb8; --bolt: #24425e;
  --bolt-edge: #6cb6f5; --nut: #4d3b22; --nut-edge: #e3ac5b; } }
.profiles text { fill: var(--ink); font: 13px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
.profiles .title { font-size: 16px; font-weight: 600; }
.profiles .soft { fill: var(--faint); } .profiles .small { font-size: 11px; }
.profiles .middle { text-anchor: middle; } .profiles .end { text-anchor: end; }
.profiles .ground { fill: var(--paper); }
.profiles .bolt { fill: var(--bolt); } .profiles .nut { fill: var(--nut); }
.profiles .bolt-edge { fill: none; stroke: var(--bolt-edge); stroke-width: 1.6; stroke-linejoin: round; }
.profiles .nut-edge { fill: none; stroke: var(--nut-edge); stroke-width: 1.6; stroke-linejoin: round; }
.profiles .part { font-weight: 600; }
.profiles .of-bolt { fill: var(--bolt-edge); } .profiles .of-nut { fill: var(--nut-edge); }
.profiles .level { fill: none; stroke: var(--faint); stroke-width: 0.8; stroke-dasharray: 5 4; }
.profiles .dimension { fill: none; stroke: var(--ink); stroke-width: 1.1; } .profiles .head { fill: var(--ink); }
"""


@dataclass(frozen=True, slots=True)
class _Panel:
    """The section of one pair, and where it is in the picture."""

    pair: Pair
    unit: LengthUnit
    top: float

    @property
    def high(self) -> float:
        """The largest radius that is drawn."""
        return self.pair.nut.major_diameter / 2.0 + BODY * self.pair.thread_pitch

    @property
    def low(self) -> float:
        """The smallest one."""
        return self.pair.bolt.minor_diameter / 2.0 - BODY * self.pair.thread_pitch

    @property
    def bottom(self) -> float:
        """Where the section ends, in pixels from the top."""
        return self.y(self.low)

    @property
    def height(self) -> float:
        """Of the panel with its texts, in pixels."""
        return TOP + (self.high - self.low) / self.pair.thread_pitch * PITCH_PX + BETWEEN

    def x(self, pitches: float) -> float:
        """Where an axial position is, given in thread pitches, in pixels from the left."""
        return LEFT + (pitches - START) * PITCH_PX

    def y(self, radius: float) -> float:
        """Where a radius is, in pixels from the top."""
        return self.top + TOP + (self.high - radius) / self.pair.thread_pitch * PITCH_PX

    def length(self, value: float) -> str:
        """A length of the pair in the unit shown."""
        shown = value * conversion_factor(self.pair.unit, self.unit)
        text = f"{shown:.{DECIMALS[self.unit]}f}".rstrip("0").rstrip(".")
        return text.removeprefix("-") if float(text) == 0.0 else text


def profiles_svg(pairs: Sequence[Pair], unit: LengthUnit | None = None) -> str:
    """The picture of pairs below each other, lengths in a unit (None: in each pair's own).

    The same pairs give the same text.
    """
    panels: list[_Panel] = []
    top = MARGIN - 16.0
    for pair in pairs:
        panels.append(_Panel(pair, unit or pair.unit, top))
        top += panels[-1].height
    height = round(top + MARGIN - 8.0)
    title = f"Thread profiles: {'; '.join(pair.designation for pair in pairs)}"
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" class="profiles" viewBox="0 0 {WIDTH} {height}" '
            f'width="{WIDTH}" height="{height}" role="img" aria-label="{escape(title)}">',
            f"<title>{escape(title)}</title>",
            f"<style>{_STYLE}</style>",
            f'<rect class="ground" width="{WIDTH}" height="{height}"/>',
            *(line for panel in panels for line in _panel(panel)),
            "</svg>",
            "",
        ]
    )


def _panel(panel: _Panel) -> Iterator[str]:
    pair = panel.pair
    yield f'<text class="title" x="{MARGIN}" y="{panel.top + 22.0:.1f}">{escape(_title(pair))}</text>'
    yield f'<text class="soft" x="{MARGIN}" y="{panel.top + 42.0:.1f}">{escape(_subtitle(panel))}</text>'
    if (source := source_of(pair)) is not None:
        yield f'<text class="soft small" x="{MARGIN}" y="{panel.top + 58.0:.1f}">{escape(source)}</text>'
    left, right = panel.x(START), panel.x(END)
    for name, profile, edge, shift in (
        ("nut", pair.nut, panel.y(panel.high), 0.0),
        ("bolt", pair.bolt, panel.bottom, _to_the_middle(pair)),
    ):
        path = _outline(panel, profile, shift)
        yield f'<path class="{name}" d="{path}V{edge:.2f}H{left:.2f}Z"/>'
        yield f'<path class="{name}-edge" d="{path}"/>'
    yield f'<text class="part of-nut" x="{left + 12.0:.1f}" y="{panel.y(panel.high) + 24.0:.1f}">nut</text>'
    yield f'<text class="part of-bolt" x="{left + 12.0:.1f}" y="{panel.bottom - 14.0:.1f}">bolt</text>'
    yield from _diameters(panel, left, right)
    yield from _radial_plays(panel)
    yield from _axial_play(panel)
    yield from _thread_pitch(panel)


def _to_the_middle(pair: Pair) -> float:
    """How far up a bolt in phase is midway in its axial play, in thread pitches: 0 of flanks of one angle."""
    if play_of(pair).axial is None:
        return 0.0
    down, up = axial_limits(pair)
    return (up - down) / 2.0 / pair.thread_pitch


def _title(pair: Pair) -> str:
    name = pair.designation
    return name if len(name) <= MOST_CHARACTERS else f"{name[: MOST_CHARACTERS - 1]}\u2026"


def _subtitle(panel: _Panel) -> str:
    pair = panel.pair
    of = " of a left-hand thread" if pair.hand is Hand.LEFT else ""
    if pair.starts > 1:
        of = f"{of or ' of a thread'} of {pair.starts} starts"
    return f"Axial section{of}, the axes in line and the bolt midway in its axial play; lengths in {UNITS[panel.unit]}"


def _outline(panel: _Panel, profile: Profile, shift: float) -> str:
    """A profile from the left end of the section to the right one: straight lines, and its fillets as arcs.

    ``shift`` is how far it is moved to the right, in thread pitches.
    """
    p, pitch_radius = profile.thread_pitch, profile.pitch_diameter / 2.0
    minor, major = profile.minor_diameter / 2.0, profile.major_diameter / 2.0
    small, large = (radius / p * PITCH_PX for radius in (profile.minor_fillet_radius, profile.major_fillet_radius))
    halves = [
        ([place / p for place in boundaries], 1.0 / math.tan(half_angle))
        for boundaries, half_angle in zip(
            (profile.boundaries, profile.falling_boundaries), profile.half_angles, strict=True
        )
    ]
    (up, rise), (down, fall) = halves

    def place(s: float, radius: float) -> str:
        return f"{panel.x(s + shift):.2f} {panel.y(radius):.2f}"

    def arc(size: float, sweep: int, s: float, radius: float) -> str:
        return f"A{size:.3f} {size:.3f} 0 0 {sweep} {place(s, radius)}"

    def on_flank(u: float, slope: float) -> float:
        return pitch_radius + u * p * slope

    def groove(falling: float, rising: float) -> list[str]:
        """Between the flanks that cross the pitch radius at these two positions."""
        return [
            f"L{place(falling - down[1], on_flank(down[1], fall))}",
            arc(small, 0, falling - down[0], minor),
            f"L{place(rising + up[0], minor)}",
            arc(small, 0, rising + up[1], on_flank(up[1], rise)),
        ]

    ridge = [
        f"L{place(up[2], on_flank(up[2], rise))}",
        arc(large, 1, up[3], major),
        f"L{place(0.5 - down[3], major)}",
        arc(large, 1, 0.5 - down[2], on_flank(down[2], fall)),
    ]
    return "".join(
        [
            f"M{panel.x(START):.2f} {panel.y(on_flank(shift, fall)):.2f}",
            *groove(START, 0.0),
            *ridge,
            *groove(0.5, END),
            f"L{panel.x(END):.2f} {panel.y(on_flank(-shift, rise)):.2f}",
        ]
    )


def _diameters(panel: _Panel, left: float, right: float) -> Iterator[str]:
    """The bolt's diameters on the left, the nut's on the right, with lines to where the profiles have them."""
    bolt, nut = panel.pair.bolt, panel.pair.nut
    crest, left_root, right_root = (panel.x(s) for s in (0.25, -0.25, 0.75))
    for profile, start, sign, anchor, major_to, minor_to, part in (
        (bolt, left, -1.0, " end", crest, left_root, "of-bolt"),
        (nut, right, 1.0, "", crest, right_root, "of-nut"),
    ):
        for name, diameter, end in (
            ("major", profile.major_diameter, major_to),
            ("pitch", profile.pitch_diameter, start),
            ("minor", profile.minor_diameter, minor_to),
        ):
            y = panel.y(diameter / 2.0)
            yield f'<path class="level" d="M{start + 6.0 * sign:.2f} {y:.2f}H{end:.2f}"/>'
            yield (
                f'<text class="{part}{anchor}" x="{start + 10.0 * sign:.2f}" y="{y + 4.5:.2f}">{name} '
                f"\u2300 {panel.length(diameter)}</text>"
            )


def _radial_plays(panel: _Panel) -> Iterator[str]:
    """Over the bolt's crest and below the nut's."""
    bolt, nut, play = panel.pair.bolt, panel.pair.nut, play_of(panel.pair)
    for s, outer, inner, value, is_above in (
        (0.25, nut.major_diameter, bolt.major_diameter, play.crest, True),
        (0.75, nut.minor_diameter, bolt.minor_diameter, play.root, False),
    ):
        x, top, bottom = panel.x(s), panel.y(outer / 2.0), panel.y(inner / 2.0)
        yield from _arrow((x, top - ARROW_PX), (x, top))
        yield from _arrow((x, bottom + ARROW_PX), (x, bottom))
        texts = "radial play", f"{panel.length(value)} {panel.unit} {_share(value / panel.pair.thread_pitch)}"
        y = top - ARROW_PX - 4.0 if is_above else bottom + ARROW_PX - 4.0
        anchor, shift = ("start", 9.0) if is_above else ("end", -9.0)
        yield from _lines(texts, x + shift, y, anchor)


def _axial_play(panel: _Panel) -> Iterator[str]:
    """Between two flanks, where they are nearest; half way up, where they are as near there as half a pixel tells."""
    pair = panel.pair
    bolt, nut, p = pair.bolt, pair.nut, pair.thread_pitch
    play = play_of(pair)
    gap, radius = play.axial, play.radius
    if gap is None or radius is None:
        return
    middle = max(bolt.pitch_diameter, nut.minor_diameter) / 2.0
    shift = _to_the_middle(pair)
    if bolt.falling_inverse(middle) - nut.falling_inverse(middle) - shift * p <= gap + HALF_A_PIXEL * p:
        radius = middle
    y = panel.y(radius)
    start, end = panel.x(0.5 - bolt.falling_inverse(radius) / p + shift), panel.x(0.5 - nut.falling_inverse(radius) / p)
    yield from _arrow((start - ARROW_PX, y), (start, y))
    yield from _arrow((end + ARROW_PX, y), (end, y))
    overlap = panel.length(-gap)
    if gap < 0.0 and overlap != "0":
        texts = "no axial play:", "overlap", f"{overlap} {panel.unit}"
    else:
        texts = "axial play", f"\u00b1{panel.length(gap)} {panel.unit}", _share(abs(gap) / p)
    # Where there is more room: each part is wider towards its own body.
    if radius <= (bolt.pitch_diameter + nut.pitch_diameter) / 4.0:
        yield from _lines(texts, start - ARROW_PX - 8.0, y + 4.5, "end")
    else:
        yield from _lines(texts, end + ARROW_PX + 8.0, y - 27.5, "start")


def _lines(texts: Sequence[str], x: float, y: float, anchor: str) -> Iterator[str]:
    """Lines of text, the first at that height."""
    for line, text in enumerate(texts):
        yield f'<text class="{anchor}" x="{x:.2f}" y="{y + 16.0 * line:.2f}">{text}</text>'


def _share(pitches: float) -> str:
    return f"({100.0 * pitches:.1f} % of p)"


def _thread_pitch(panel: _Panel) -> Iterator[str]:
    """From groove to groove of the bolt, below it."""
    left, right, y = panel.x(-0.25), panel.x(0.75), panel.bottom + 16.0
    for x in (left, right):
        yield f'<path class="level" d="M{x:.2f} {panel.bottom:.2f}V{y + 6.0:.2f}"/>'
    middle = (left + right) / 2.0
    yield from _arrow((middle - 90.0, y), (left, y))
    yield from _arrow((middle + 90.0, y), (right, y))
    text = f"thread pitch p = {panel.length(panel.pair.thread_pitch)} {panel.unit}"
    yield f'<text class="middle" x="{middle:.2f}" y="{y + 4.5:.2f}">{text}</text>'


def _arrow(start: tuple[float, float], end: tuple[float, float]) -> Iterator[str]:
    """A line with a head at its end, along x or y."""
    (x, y), (to_x, to_y) = start, end
    size = math.dist(start, end)
    along, up = (to_x - x) / size, (to_y - y) / size
    back, half = 8.0, 2.8
    base = to_x - back * along, to_y - back * up
    corners = [
        (to_x, to_y),
        (base[0] - half * up, base[1] + half * along),
        (base[0] + half * up, base[1] - half * along),
    ]
    yield f'<path class="dimension" d="M{x:.2f} {y:.2f}L{base[0]:.2f} {base[1]:.2f}"/>'
    yield f'<path class="head" d="M{"L".join(f"{a:.2f} {b:.2f}" for a, b in corners)}Z"/>'
