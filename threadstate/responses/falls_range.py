"""Falls of an orientation that is known to a tolerance alone: the range of what the tilts within it give."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence

from threadstate.errors import InvalidValueError
from threadstate.history.descents import falls_of
from threadstate.history.falls import SNAP_PITCHES, SPAN_DEG
from threadstate.history.height_curve import height_curve
from threadstate.numbers import number_text
from threadstate.responses.documents import FallsDocument, FallsRangeDocument
from threadstate.responses.windows import falls_document
from threadstate.state.options import TILT_LIMIT_DEG, SolveOptions
from threadstate.thread.pair import Pair

STEPS = 3
"""Number of values of roll, and of pitch: both ends of the tolerance and its middle."""
MOST_STEPS = 9
LARGEST_TOLERANCE_DEG = 2.0
LARGEST_SPAN_DEG = 90.0

Tilt = tuple[float, float]


def computed_falls(
    pair: Pair,
    options: SolveOptions,
    roll_deg: float,
    pitch_deg: float,
    factor: float,
    span_deg: float = SPAN_DEG,
    least_pitches: float = SNAP_PITCHES,
) -> FallsDocument:
    """The falls of any orientation, lengths multiplied by ``factor``: from first contacts alone, without a history.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg, a span beyond 90 deg.
    """
    if not 0.0 < span_deg <= LARGEST_SPAN_DEG:
        raise InvalidValueError("span", span_deg, f"above 0, at most {number_text(LARGEST_SPAN_DEG)} deg")
    falls = falls_of(height_curve(pair, roll_deg, pitch_deg, options), pair.thread_pitch, span_deg)
    return falls_document(falls, roll_deg, pitch_deg, pair, factor, least_pitches)


def tilts_within(roll_deg: float, pitch_deg: float, tolerance_deg: float, steps: int = STEPS) -> list[Tilt]:
    """The tilts within the tolerance: ``steps`` by ``steps`` evenly spaced ones, including the corners.

    Raises:
        InvalidValueError: a tolerance or a number of steps out of range, or a tilt beyond 10 deg.
    """
    if not 0.0 < tolerance_deg <= LARGEST_TOLERANCE_DEG:
        raise InvalidValueError(
            "tolerance", tolerance_deg, f"above 0, at most {number_text(LARGEST_TOLERANCE_DEG)} deg"
        )
    if steps not in range(STEPS, MOST_STEPS + 1, 2):
        raise InvalidValueError("steps", steps, f"an odd number, {STEPS} to {MOST_STEPS}")
    for name, angle in (("roll", roll_deg), ("pitch", pitch_deg)):
        if not abs(angle) + tolerance_deg <= TILT_LIMIT_DEG:
            raise InvalidValueError(
                f"{name} with its tolerance",
                f"{number_text(angle)} +- {number_text(tolerance_deg)}",
                f"{number_text(-TILT_LIMIT_DEG)} to {number_text(TILT_LIMIT_DEG)} deg",
            )
    half = steps // 2
    offsets = [tolerance_deg * k / half for k in range(-half, half + 1)]
    return [(roll_deg + a, pitch_deg + b) for a in offsets for b in offsets]


def falls_range(
    falls: Callable[[float, float], FallsDocument],
    roll_deg: float,
    pitch_deg: float,
    tolerance_deg: float,
    tilts: Iterable[Tilt],
) -> FallsRangeDocument:
    """The range of the falls of ``tilts``, each computed by ``falls``; lengths in the unit of these.

    Phases that differ by a turn are taken next to each other. Between the tilts falls may be beyond the range: it is
    that of the tilts given.
    """
    found = [falls(*tilt) for tilt in tilts]
    snaps = [one.snap for one in found if one.snap is not None]
    starts = list(_beside(snap.start for snap in snaps))
    spans = [snap.end - snap.start for snap in snaps]
    return FallsRangeDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        tolerance=tolerance_deg,
        tilts=len(found),
        snaps=len(snaps),
        steepest=_range([one.steepest for one in found]) or (0.0, 0.0),
        fall=_range([snap.fall for snap in snaps]),
        snap_from=_range(starts),
        snap_to=_range([start + span for start, span in zip(starts, spans, strict=True)]),
        jump=_range([snap.jump for snap in snaps]),
    )


def _beside(phases: Iterable[float]) -> Iterator[float]:
    """Phases, each with as many turns as bring it nearest to the first."""
    first = None
    for phase in phases:
        first = phase if first is None else first
        yield phase - 360.0 * math.floor((phase - first) / 360.0 + 0.5)


def _range(values: Sequence[float]) -> tuple[float, float] | None:
    return (min(values), max(values)) if values else None
