"""Clearance windows as documents."""

from __future__ import annotations

from threadstate.answer.documents import CourseDocument, SnapDocument, WindowDocument
from threadstate.answer.lengths import scaled
from threadstate.archive.stored import StoredHistories
from threadstate.history.window import Course, Snap, Window


def window_document(
    window: Window, roll_deg: float, pitch_deg: float, thread_pitch: float, factor: float
) -> WindowDocument:
    """The document of a window, lengths multiplied by ``factor``; ``thread_pitch`` in the unit before that."""
    return WindowDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        enter=window.enter_deg,
        leave=window.leave_deg,
        width=window.width_deg,
        drop=window.drop * factor,
        climb=window.climb * factor,
        enter_height=window.enter_height * factor,
        leave_height=window.leave_height * factor,
        lowest_phase=window.lowest_deg % 360.0,
        lowest_height=window.lowest_height * factor,
        snap=None if window.snap is None else _snap(window.snap, factor),
        courses=[_course(course, thread_pitch, factor) for course in window.courses],
    )


def windows_of_histories(
    histories: StoredHistories, roll_deg: float | None, pitch_deg: float | None, thread_pitch: float, factor: float
) -> list[WindowDocument]:
    """The windows of a library's orientations, of one roll or pitch alone if these are given; by orientation."""
    found = []
    for number, history in enumerate(histories.orientations):
        roll, pitch = histories.tilt_deg(number)
        if roll_deg in (None, roll) and pitch_deg in (None, pitch):
            found += [window_document(one, roll, pitch, thread_pitch, factor) for one in history.windows]
    return found


def _snap(snap: Snap, factor: float) -> SnapDocument:
    return SnapDocument(
        phase=snap.phase_deg,
        phase_uncertainty=0.5 * snap.width_deg,
        height_before=snap.height_before * factor,
        height_after=snap.height_after * factor,
        height_uncertainty=scaled(snap.height_error, factor),
        fall=snap.fall * factor,
    )


def _course(course: Course, thread_pitch: float, factor: float) -> CourseDocument:
    return CourseDocument(
        features=course.features,
        start=course.start_deg,
        end=course.end_deg,
        start_height=course.start_height * factor,
        end_height=course.end_height * factor,
        rate=course.rate_per_lead(thread_pitch),
    )
