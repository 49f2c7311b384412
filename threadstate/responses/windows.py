"""Falls and clearance windows as documents."""

from __future__ import annotations

from threadstate.history.falls import SNAP_PITCHES, Descent, Falls, Jump
from threadstate.history.window import Course, Window
from threadstate.responses.documents import (
    CourseDocument,
    DescentDocument,
    FallsDocument,
    JumpDocument,
    OrientationWindowsDocument,
    SnapDocument,
    WindowDocument,
)
from threadstate.stored_histories.model import StoredHistories, StoredHistory
from threadstate.thread.pair import Pair


def falls_document(
    falls: Falls,
    roll_deg: float,
    pitch_deg: float,
    pair: Pair,
    factor: float,
    least_pitches: float = SNAP_PITCHES,
) -> FallsDocument:
    """The document of an orientation's falls, lengths in the pair's unit multiplied by ``factor``.

    A steepest fall of more than ``least_pitches`` thread pitches is that of a snap.
    """
    steepest = falls.steepest
    return FallsDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        steepest=0.0 if steepest is None else steepest.fall * factor,
        steepest_from=None if steepest is None else steepest.start_deg,
        snap=_snap(falls, least_pitches * pair.thread_pitch, factor),
        descents=[_descent(descent, factor) for descent in falls.descents],
    )


def windows_document(
    history: StoredHistory,
    roll_deg: float,
    pitch_deg: float,
    pair: Pair,
    factor: float,
    least_pitches: float = SNAP_PITCHES,
) -> OrientationWindowsDocument:
    """The document of an orientation's falls and windows; see :func:`falls_document`."""
    falls = falls_document(history.falls, roll_deg, pitch_deg, pair, factor, least_pitches)
    windows = [_window(window, roll_deg, pitch_deg, pair, factor) for window in history.windows]
    return OrientationWindowsDocument(**dict(falls), windows=windows)


def windows_of_histories(
    histories: StoredHistories,
    roll_deg: float | None,
    pitch_deg: float | None,
    pair: Pair,
    factor: float,
    least_pitches: float = SNAP_PITCHES,
) -> list[OrientationWindowsDocument]:
    """Falls and windows of a library's orientations, of one roll or pitch alone if these are given; in their order."""
    found = []
    for number, history in enumerate(histories.orientations):
        roll, pitch = histories.tilt_deg(number)
        if roll_deg in (None, roll) and pitch_deg in (None, pitch):
            found.append(windows_document(history, roll, pitch, pair, factor, least_pitches))
    return found


def _snap(falls: Falls, least_fall: float, factor: float) -> SnapDocument | None:
    descent = falls.snap(least_fall)
    if descent is None or falls.steepest is None:
        return None
    jump = descent.largest_jump
    return SnapDocument(
        start=descent.start_deg,
        end=descent.end_deg,
        fall=descent.fall * factor,
        steepest=falls.steepest.fall * factor,
        steepest_from=falls.steepest.start_deg,
        jump=0.0 if jump is None else jump.fall * factor,
        jump_at=None if jump is None else jump.phase_deg,
    )


def _descent(descent: Descent, factor: float) -> DescentDocument:
    return DescentDocument(
        start=descent.start_deg,
        end=descent.end_deg,
        fall=descent.fall * factor,
        from_height=descent.start_height * factor,
        to_height=descent.end_height * factor,
        fall_uncertainty=descent.fall_error * factor,
        undecided=descent.undecided_deg,
        jumps=[_jump(jump, factor) for jump in descent.jumps],
    )


def _jump(jump: Jump, factor: float) -> JumpDocument:
    return JumpDocument(
        phase=jump.phase_deg,
        phase_uncertainty=0.5 * jump.width_deg,
        height_before=jump.height_before * factor,
        height_after=jump.height_after * factor,
        height_uncertainty=jump.height_error * factor,
        fall=jump.fall * factor,
    )


def _window(window: Window, roll_deg: float, pitch_deg: float, pair: Pair, factor: float) -> WindowDocument:
    return WindowDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        enter=window.enter_deg,
        leave=window.leave_deg,
        width=window.width_deg,
        climb=window.climb * factor,
        enter_height=window.enter_height * factor,
        leave_height=window.leave_height * factor,
        lowest_phase=window.lowest_deg % 360.0,
        lowest_height=window.lowest_height * factor,
        courses=[_course(course, pair.lead, factor) for course in window.courses],
    )


def _course(course: Course, lead: float, factor: float) -> CourseDocument:
    return CourseDocument(
        features=course.features,
        start=course.start_deg,
        end=course.end_deg,
        start_height=course.start_height * factor,
        end_height=course.end_height * factor,
        rate=course.rate_per_lead(lead),
    )
