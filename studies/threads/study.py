"""Windows and falls of pairs over tilts: what class, position, form and size of a thread change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.falls import SNAP_PITCHES
from threadstate.history.height_curve import height_curve
from threadstate.history.window import windows_of
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.play import axial_play

TILTS_DEG = (-4.0, -2.0, 0.0, 2.0, 4.0)
LEVEL = (0.0, 0.0)

POSITIONS = ("", " at middle", " at minimum material")
CLASSES = tuple(f"1/4-20 UNC-{number}A/{number}B{position}" for number in (3, 2, 1) for position in POSITIONS)
FORMS = tuple(
    f"{size}{position}"
    for size in (
        "1/4-20 UNC-2A/2B",
        "1/4-28 UNF-2A/2B",
        "M6x1-6g/6H",
        "1/4-20 BSW-medium/normal",
        "Tr 8x1.5-7e/7H",
        "1/4-16 STUB ACME-2G",
        "1/4-16 ACME-2G",
    )
    for position in ("", " at minimum material")
)
SIZES = (
    "M3x0.5-6g/6H",
    "M6x1-6g/6H",
    "M12x1.75-6g/6H",
    "M30x3.5-6g/6H",
    "4-40 UNC-2A/2B",
    "1/4-20 UNC-2A/2B",
    "1-8 UNC-2A/2B",
)
FITS = ("M6x1-4h/5H", "M6x1-6h/6H", "M6x1-6g/6H", "M6x1-6e/6H", "M6x1-6g/6G", "M6x1-8g/7H")


@dataclass(frozen=True)
class Thread:
    """What was found of a pair: play and falls over the thread pitch, windows in degrees.

    Attributes:
        designation: of the pair.
        form: of its thread.
        play: axial play of a bolt in phase, over the thread pitch.
        windows_deg: how much phase the windows of each orientation cover.
        falls: the steepest fall of each orientation, over the thread pitch.
    """

    designation: str
    form: str
    play: float
    windows_deg: tuple[float, ...]
    falls: tuple[float, ...]

    @property
    def window_deg(self) -> float:
        """The median over the orientations."""
        return median(self.windows_deg)

    @property
    def fall(self) -> float:
        """The median over the orientations."""
        return median(self.falls)

    @property
    def snaps(self) -> int:
        """Orientations whose steepest fall is that of a snap."""
        return sum(fall > SNAP_PITCHES for fall in self.falls)


def orientations(tilts_deg: Sequence[float] = TILTS_DEG) -> list[tuple[float, float]]:
    """Roll and pitch of all but the level one."""
    return [(roll, pitch) for roll in tilts_deg for pitch in tilts_deg if (roll, pitch) != LEVEL]


def looked_at(designation: str, tilts_deg: Sequence[float] = TILTS_DEG) -> Thread:
    """Windows and falls of a pair."""
    pair, options = pair_by_designation(designation), SolveOptions()
    tilts = orientations(tilts_deg)
    windows = [
        sum(window.width_deg for window in windows_of(pair, history)) for history in histories_of(pair, tilts, options)
    ]
    steepest = [falls_of(height_curve(pair, *tilt, options), pair.thread_pitch).steepest for tilt in tilts]
    falls = [0.0 if one is None else one.fall / pair.thread_pitch for one in steepest]
    play = axial_play(pair) / pair.thread_pitch
    return Thread(pair.designation, str(pair.form.name), play, tuple(windows), tuple(falls))
