"""Limits of ISO metric threads, ISO 965-1, in millimetres.

The formulas are the standard's. Its tables smooth what they give: the tolerance of grade 6 lies on the series R40,
every other grade so many steps of it away, and a few values are the table's own.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded

R40 = (
    *(1.0, 1.06, 1.12, 1.18, 1.25, 1.32, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.12, 2.24, 2.36, 2.5, 2.65, 2.8, 3.0),
    *(3.15, 3.35, 3.55, 3.75, 4.0, 4.25, 4.5, 4.75, 5.0, 5.3, 5.6, 6.0, 6.3, 6.7, 7.1, 7.5, 8.0, 8.5, 9.0, 9.5),
)
"""Renard's series of 40 numbers a decade, as ISO 3 rounds it."""
STEPS_OF_A_GRADE = 4
STEPS_OF_A_NUT = 5
"""Steps of the series from the pitch diameter's tolerance of a bolt to that of a nut."""
RANGES_MM = (0.99, 1.4, 2.8, 5.6, 11.2, 22.4, 45.0, 90.0, 180.0, 355.0)
"""Diameters between which a tolerance is one, over and up to."""
HEIGHT_3_4, HEIGHT_5_4 = 0.64951905, 1.08253175
ROOT_LEAST = 0.616025
"""Below the pitch diameter, over the pitch: the minor diameter of the least root radius, an eighth of the pitch."""

_PITCH_6 = {(2.8, 0.5): 75, (45.0, 5.0): 250, (180.0, 3.0): 250, (180.0, 4.0): 280}
_CREST_6 = {4.0: 475}
_MINOR_6 = {0.25: 71, 0.5: 140, 2.5: 450}
_DEVIATION_G = {0.75: 22, 8.0: 100}
_DEVIATION_E = {0.5: 50, 0.6: 53, 0.75: 56, 2.5: 80}
_DEVIATION_F = {
    0.35: 34,
    0.4: 34,
    0.45: 35,
    0.5: 36,
    0.6: 36,
    0.7: 38,
    0.75: 38,
    0.8: 38,
    1.0: 40,
    1.25: 42,
    1.5: 45,
    1.75: 48,
    2.0: 52,
    2.5: 58,
    3.0: 63,
    3.5: 70,
    4.0: 75,
    4.5: 80,
    5.0: 85,
    5.5: 90,
    6.0: 95,
}
"""Values of the tables, in micrometres, that the rule does not give."""

COARSE_MM = {
    1.6: 0.35,
    2.0: 0.4,
    2.5: 0.45,
    3.0: 0.5,
    3.5: 0.6,
    4.0: 0.7,
    5.0: 0.8,
    6.0: 1.0,
    8.0: 1.25,
    10.0: 1.5,
    12.0: 1.75,
    14.0: 2.0,
    16.0: 2.0,
    18.0: 2.5,
    20.0: 2.5,
    22.0: 2.5,
    24.0: 3.0,
    27.0: 3.0,
    30.0: 3.5,
    33.0: 3.5,
    36.0: 4.0,
    39.0: 4.0,
    42.0: 4.5,
    45.0: 4.5,
    48.0: 5.0,
    52.0: 5.0,
    56.0: 5.5,
    60.0: 5.5,
    64.0: 6.0,
}
"""Pitches of the coarse series by diameter: what ``M6`` means."""


FINE_MM = {
    8.0: (1.0,),
    10.0: (1.25, 1.0),
    12.0: (1.5, 1.25),
    14.0: (1.5,),
    16.0: (1.5,),
    18.0: (2.0, 1.5),
    20.0: (2.0, 1.5),
    22.0: (2.0, 1.5),
    24.0: (2.0,),
    27.0: (2.0,),
    30.0: (2.0,),
    33.0: (2.0,),
    36.0: (3.0,),
    39.0: (3.0,),
    42.0: (3.0,),
    45.0: (3.0,),
    48.0: (3.0,),
    52.0: (4.0,),
    56.0: (4.0,),
    60.0: (4.0,),
    64.0: (4.0,),
}
"""Finer pitches that are preferred, by diameter."""


def sizes_mm() -> tuple[tuple[float, float], ...]:
    """Diameters and pitches of the coarse series and the preferred fine ones, the smallest first."""
    return tuple(
        (diameter, pitch) for diameter, coarse in COARSE_MM.items() for pitch in (coarse, *FINE_MM.get(diameter, ()))
    )


@dataclass(frozen=True, slots=True)
class MetricClass:
    """A tolerance class: grade and position of the pitch diameter, then those of the crest (``5g6g``, ``6H``)."""

    pitch_grade: int
    pitch_position: str
    crest_grade: int
    crest_position: str


def metric_class(text: str) -> MetricClass:
    """The class of a text, as ``6g``, ``4g6g`` or ``6H``.

    Raises:
        InvalidValueError: it is none.
    """
    parts = [text[k : k + 2] for k in range(0, len(text), 2)]
    if len(text) not in (2, 4) or any(not part[0].isdecimal() or not part[1].isalpha() for part in parts):
        raise InvalidValueError("tolerance class", text, "a grade and a position, such as 6g, 4g6g or 6H")
    first, last = parts[0], parts[-1]
    return MetricClass(int(first[0]), first[1], int(last[0]), last[1])


def pitch_tolerance_um(diameter_mm: float, pitch_mm: float, grade: int, *, nut: bool) -> float:
    """The tolerance of the pitch diameter of a bolt or a nut at a grade."""
    low, high = _range(diameter_mm)
    formula = 90.0 * pitch_mm**0.4 * math.sqrt(low * high) ** 0.1
    index = _index(_PITCH_6.get((low, pitch_mm), formula))
    return _whole(index + STEPS_OF_A_GRADE * (grade - 6) + (STEPS_OF_A_NUT if nut else 0))


def crest_tolerance_um(pitch_mm: float, grade: int) -> float:
    """The tolerance of a bolt's major diameter at a grade."""
    formula = 180.0 * pitch_mm ** (2.0 / 3.0) - 3.15 / math.sqrt(pitch_mm)
    return _whole(_index(_CREST_6.get(pitch_mm, formula)) + STEPS_OF_A_GRADE * (grade - 6))


def minor_tolerance_um(pitch_mm: float, grade: int) -> float:
    """The tolerance of a nut's minor diameter at a grade."""
    formula = 230.0 * pitch_mm**0.7 if pitch_mm >= 1.0 else 433.0 * pitch_mm - 190.0 * pitch_mm**1.22
    return _whole(_index(_MINOR_6.get(pitch_mm, formula)) + STEPS_OF_A_GRADE * (grade - 6))


def deviation_um(pitch_mm: float, position: str) -> float:
    """How far a bolt's diameters lie below the basic ones (h, g, f, e), or a nut's above them (H, G).

    Raises:
        InvalidValueError: the position is none of these, or the standard has none at that pitch.
    """
    match position:
        case "h" | "H":
            return 0.0
        case "g" | "G":
            return _DEVIATION_G.get(pitch_mm, _whole(_index(15.0 + 11.0 * pitch_mm)))
        case "e" if pitch_mm >= 0.5:
            return _DEVIATION_E.get(pitch_mm, _whole(_index(50.0 + 11.0 * pitch_mm)))
        case "f" if pitch_mm in _DEVIATION_F:
            return _DEVIATION_F[pitch_mm]
    raise InvalidValueError("position of a tolerance", position, "e, f, g, h of a bolt, G, H of a nut")


def bolt_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str) -> Limits:
    """Limits of a bolt; its minor diameter is from that of the least root radius to that of a flat root.

    Raises:
        InvalidValueError: no such class of a bolt.
    """
    given = metric_class(tolerance_class)
    if given.pitch_position not in "efgh" or given.crest_position != given.pitch_position:
        raise InvalidValueError("tolerance class", tolerance_class, "a bolt's: its position is e, f, g or h")
    _checked_grades(tolerance_class, given, pitch_mm, pitch_grades=range(3, 10), crest_grades=(4, 6, 8))
    below = deviation_um(pitch_mm, given.pitch_position)
    pitch = _millimetres(diameter_mm - HEIGHT_3_4 * pitch_mm)
    greatest = _lessened(diameter_mm, below)
    pitch_greatest = _lessened(pitch, below)
    pitch_least = _lessened(pitch_greatest, pitch_tolerance_um(diameter_mm, pitch_mm, given.pitch_grade, nut=False))
    least = _lessened(greatest, crest_tolerance_um(pitch_mm, given.crest_grade))
    minor = Diameter(
        _millimetres(pitch_least - ROOT_LEAST * pitch_mm), _millimetres(pitch_greatest - HEIGHT_1_2 * pitch_mm)
    )
    return Limits(Diameter(least, greatest), Diameter(pitch_least, pitch_greatest), minor)


HEIGHT_1_2 = 0.433013
"""Below the pitch diameter, over the pitch: the minor diameter of a flat root of a quarter of the pitch."""


def nut_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str) -> Limits:
    """Limits of a nut; its major diameter has no greatest one.

    Raises:
        InvalidValueError: no such class of a nut.
    """
    given = metric_class(tolerance_class)
    if given.pitch_position not in "GH" or given.crest_position != given.pitch_position:
        raise InvalidValueError("tolerance class", tolerance_class, "a nut's: its position is G or H")
    _checked_grades(tolerance_class, given, pitch_mm, pitch_grades=range(4, 9), crest_grades=range(4, 9))
    above = -deviation_um(pitch_mm, given.pitch_position)
    pitch_least = _lessened(_millimetres(diameter_mm - HEIGHT_3_4 * pitch_mm), above)
    minor_least = _lessened(_millimetres(diameter_mm - HEIGHT_5_4 * pitch_mm), above)
    return Limits(
        Diameter(_lessened(diameter_mm, above), None),
        Diameter(
            pitch_least,
            _lessened(pitch_least, -pitch_tolerance_um(diameter_mm, pitch_mm, given.pitch_grade, nut=True)),
        ),
        Diameter(minor_least, _lessened(minor_least, -minor_tolerance_um(pitch_mm, given.crest_grade))),
    )


def _checked_grades(
    text: str, given: MetricClass, pitch_mm: float, *, pitch_grades: range, crest_grades: range | tuple[int, ...]
) -> None:
    if given.pitch_grade not in pitch_grades or given.crest_grade not in crest_grades:
        valid = f"grades {', '.join(map(str, pitch_grades))} of the pitch diameter"
        raise InvalidValueError("tolerance class", text, f"{valid}, {', '.join(map(str, crest_grades))} of the crest")
    least_pitch = {5: 0.25, 6: 0.35, 7: 0.5, 8: 0.8, 9: 0.8}
    if pitch_mm < least_pitch.get(given.pitch_grade, 0.0):
        raise InvalidValueError("tolerance class", text, f"a grade that the standard has at a pitch of {pitch_mm!r} mm")


def _range(diameter_mm: float) -> tuple[float, float]:
    at = bisect_left(RANGES_MM, diameter_mm)
    if not 0 < at < len(RANGES_MM):
        raise InvalidValueError("nominal diameter", diameter_mm, f"over {RANGES_MM[0]!r} to {RANGES_MM[-1]!r} mm")
    return RANGES_MM[at - 1], RANGES_MM[at]


def _index(value: float) -> int:
    """The place of the member of R40 that is nearest, the larger one of two: 0 is 1, 40 is 10."""
    decade = math.floor(math.log10(value))
    members = [
        (round(abs(member * 10.0**power - value), 9), -(len(R40) * power + k))
        for power in (decade - 1, decade, decade + 1)
        for k, member in enumerate(R40)
    ]
    return -min(members)[1]


def _whole(index: int) -> float:
    """A member of R40 in whole micrometres, halves to even."""
    power, k = divmod(index, len(R40))
    return rounded(R40[k] * 10.0**power, 0)


def _millimetres(value: float) -> float:
    return round(value + 1e-12, 3)


def _lessened(value_mm: float, by_um: float) -> float:
    return round(value_mm - by_um / 1000.0, 3)
