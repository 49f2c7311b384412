"""What a published library says of every orientation, in numbers that compare between threads of any size."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from sqlalchemy import Connection, func, select

from threadstate.errors import NotFoundError
from threadstate.history.falls import SNAP_PITCHES
from threadstate.library.history_tables import clearance_window, steepest_fall
from threadstate.library.identity import pair_of
from threadstate.library.orientations import OrientationSummary, orientation_summaries
from threadstate.library.read import LibraryRecord
from threadstate.library.tables import state
from threadstate.state.model import StateClass

FRICTIONS = (0.1, 0.2, 0.4)
"""Coefficients of friction at which the states that hold a push are counted."""


@dataclass(frozen=True, slots=True)
class OrientationFigures:
    """An orientation, in degrees; lengths are in thread pitches.

    ``window_deg`` is the phase that its clearance windows cover, ``widest_deg`` that of the widest alone, 0 where there
    is none; ``fall`` the steepest fall. ``embedment`` is the greatest of its states, the frictions are the least at any
    phase, as :class:`OrientationSummary` has them; None where no state has one.
    """

    roll_deg: float
    pitch_deg: float
    window_deg: float
    widest_deg: float
    fall: float
    embedment: float | None
    mu_hold: float | None
    mu_wedge: float | None

    @property
    def snaps(self) -> bool:
        """Whether its steepest fall is that of a snap (method, section 8)."""
        return self.fall > SNAP_PITCHES


@dataclass(frozen=True)
class LibraryFigures:
    """The figures of a library's orientations, in the order of roll and pitch.

    ``of_class`` is the number of states of each class, ``held`` that of the states that hold a push by each of
    :data:`FRICTIONS`.
    """

    library: LibraryRecord
    of_class: tuple[tuple[StateClass, int], ...]
    held: tuple[tuple[float, int], ...]
    orientations: tuple[OrientationFigures, ...]


def library_figures(connection: Connection, library: LibraryRecord) -> LibraryFigures:
    """The figures of a published library.

    Raises:
        NotFoundError: the library has no histories.
    """
    thread_pitch = pair_of(library.pair).thread_pitch
    fall = steepest_fall.c
    query = select(fall.orientation, fall.fall).where(fall.library_id == library.id).order_by(fall.orientation)
    falls = [(orientation, steepest) for orientation, steepest in connection.execute(query)]
    if not falls:
        raise NotFoundError(
            f"library {library.id}, by the {library.method} method, has no histories to compare; "
            "libraries of the exact method have"
        )
    window = clearance_window.c
    widths: defaultdict[int, list[float]] = defaultdict(list)
    for orientation, enter, leave in connection.execute(
        select(window.orientation, window.enter_deg, window.leave_deg)
        .where(window.library_id == library.id)
        .order_by(window.orientation, window.position)
    ):
        widths[orientation].append(leave - enter)
    summaries = {(one.roll_deg, one.pitch_deg): one for one in orientation_summaries(connection, library.id)}
    figures = []
    for orientation, steepest in falls:
        tilt = library.grid.orientation(orientation)
        summary = summaries.get((tilt.roll_deg, tilt.pitch_deg))
        figures.append(
            OrientationFigures(
                tilt.roll_deg,
                tilt.pitch_deg,
                sum(widths[orientation]),
                max(widths[orientation], default=0.0),
                steepest / thread_pitch,
                _embedment(summary, thread_pitch),
                None if summary is None else summary.mu_hold_least,
                None if summary is None else summary.mu_wedge_least,
            )
        )
    held = connection.execute(
        select(*(func.count().filter(state.c.mu_hold <= mu) for mu in FRICTIONS)).where(
            state.c.library_id == library.id
        )
    ).one()
    of_class = dict.fromkeys(StateClass, 0)
    for summary in summaries.values():
        for name, count in summary.of_class:
            of_class[name] += count
    return LibraryFigures(library, tuple(of_class.items()), tuple(zip(FRICTIONS, held, strict=True)), tuple(figures))


def _embedment(summary: OrientationSummary | None, thread_pitch: float) -> float | None:
    return None if summary is None or summary.embedment_most is None else summary.embedment_most / thread_pitch
