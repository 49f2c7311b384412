"""The answers that a rendition has: the state of a pose, and the history of an orientation as rows.

Only what can be answered for certain is: anything else takes the long way, which knows the errors too.
"""

from __future__ import annotations

import re
from functools import lru_cache

from service.kept.answers import Answer
from service.renditions.file import Rendition, compact_json
from service.representation import JSON, VARY_ACCEPT, etag_of
from service.units import UNIT_HEADER
from threadstate.library.grid import Grid
from threadstate.library.read import LibraryRecord
from threadstate.numbers import number_text

STATE_ROUTE = "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"
HISTORY_ROUTE = "/v1/libraries/{id}/histories/{roll}/{pitch}"

_ANGLE = r"(-?[0-9]{1,3}(?:\.[0-9]{1,6})?)"
_STATE = re.compile(f"/states/{_ANGLE}/{_ANGLE}/{_ANGLE}")
_HISTORY = re.compile(f"/histories/{_ANGLE}/{_ANGLE}")
_JSON = JSON.encode()
_UNIT_HEADER = UNIT_HEADER.lower().encode()


def rendered_state(rendition: Rendition, library: LibraryRecord, path: str, cached: bytes) -> Answer | None:
    """The state that ``path``, below the library's address, is about; None where it is not the path of one.

    ``cached`` is the answer's ``Cache-Control``.
    """
    match = _STATE.fullmatch(path)
    if match is None:
        return None
    roll, pitch, phase = float(match[1]), float(match[2]), float(match[3])
    first = _first_ordinal(library.grid, roll, pitch)
    place = _phase_places(library.grid).get(phase)
    if first is None or place is None:
        return None
    content = rendition.state(first + place)
    if content is None:
        return None
    location = f"/v1/libraries/{library.id}/states/{number_text(roll)}/{number_text(pitch)}/{number_text(phase)}"
    return _answer(
        STATE_ROUTE, library, content, cached, (b"content-location", location.encode()), (b"vary", b"Accept-Encoding")
    )


def rendered_history(rendition: Rendition, library: LibraryRecord, path: str, cached: bytes) -> Answer | None:
    """The history that ``path``, below the library's address, is about; None where it is not the path of one.

    ``cached`` is the answer's ``Cache-Control``.
    """
    match = _HISTORY.fullmatch(path)
    if match is None:
        return None
    roll, pitch = float(match[1]), float(match[2])
    first = _first_ordinal(library.grid, roll, pitch)
    if first is None:
        return None
    states = rendition.states(first, first + len(_phase_places(library.grid)) - 1)
    if states is None:
        return None
    head = {"library": library.id, "unit": library.length_unit.value, "roll": roll + 0.0, "pitch": pitch + 0.0}
    content = b"".join((compact_json(head)[:-1], b',"states":[', states, b'],"undecided":[]}'))
    return _answer(HISTORY_ROUTE, library, content, cached, (b"vary", f"{VARY_ACCEPT}, Accept-Encoding".encode()))


def _answer(route: str, library: LibraryRecord, content: bytes, cached: bytes, *further: tuple[bytes, bytes]) -> Answer:
    etag = etag_of(content)
    headers = [
        (b"etag", etag.encode()),
        (b"cache-control", cached),
        (_UNIT_HEADER, library.length_unit.value.encode()),
        *further,
        (b"content-length", b"%d" % len(content)),
        (b"content-type", _JSON),
    ]
    return Answer(route, etag, headers, content)


def _first_ordinal(grid: Grid, roll_deg: float, pitch_deg: float) -> int | None:
    tilts = _tilt_places(grid)
    i_roll, i_pitch = tilts.get(roll_deg), tilts.get(pitch_deg)
    if i_roll is None or i_pitch is None:
        return None
    return (i_roll * len(tilts) + i_pitch) * len(_phase_places(grid))


@lru_cache(maxsize=64)
def _tilt_places(grid: Grid) -> dict[float, int]:
    return {tilt: place for place, tilt in enumerate(grid.tilts_deg)}


@lru_cache(maxsize=64)
def _phase_places(grid: Grid) -> dict[float, int]:
    return {phase: place for place, phase in enumerate(grid.phases_deg)}
