"""The clearance window: where a bolt turned counter-clockwise falls below the nut's surface, and climbs again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from threadstate.history.codes import HEIGHT_JUMP
from threadstate.history.limits import limit_after, limit_before
from threadstate.history.model import CIRCLE_DEG, Boundary, Interval, SolvedHistory
from threadstate.state.model import ContactState, FeaturePair
from threadstate.thread.pair import Pair

WITHIN_THREAD = (FeaturePair.EDGE_THREAD, FeaturePair.THREAD_EDGE, FeaturePair.THREAD_THREAD)
"""Features of a first contact that is on a thread, beside one of a level bolt on the flank."""


@dataclass(frozen=True, slots=True)
class Course:
    """A stretch of a window over which the first contact is of the same features and its height does not jump.

    From ``start_deg`` to ``end_deg``, counted on from the window's entry; heights in the pair's unit.
    """

    features: FeaturePair
    start_deg: float
    end_deg: float
    start_height: float
    end_height: float

    def rate_per_lead(self, lead: float) -> float:
        """Mean rate of the height, as a multiple of the lead's per degree; ``lead`` in the pair's unit.

        It is 1 where the bolt's edge slides on the nut's thread: the bolt turns about the nut's axis, along which
        its thread repeats itself.
        """
        return (self.end_height - self.start_height) / (self.end_deg - self.start_deg) * CIRCLE_DEG / lead


@dataclass(frozen=True, slots=True)
class Window:
    """A stretch of phase over which the bolt passes the nut's mouth; lengths in the pair's unit.

    There no point of the bolt's edge is stopped by the nut's surface or edge, so that the first contact is on a thread
    (the paper's section 5: the bolt's radius is less than the nut's all round).

    The bolt enters at ``enter_deg`` in [0, 360) and leaves at ``leave_deg``, which is larger (above 360 where the
    window holds phase 0); heights are those of its origin at first contact. ``lowest_height`` is the least height at
    an end or in the middle of an interval of the window, ``lowest_deg`` its phase, from which on the bolt climbs by
    ``climb`` up to the exit. ``courses`` are the parts of the window in order, undecided ones left out. How far the
    bolt goes down on its way is for ``threadstate.history.descents`` to say.
    """

    enter_deg: float
    leave_deg: float
    enter_height: float
    leave_height: float
    lowest_deg: float
    lowest_height: float
    courses: tuple[Course, ...]

    @property
    def width_deg(self) -> float:
        """How much phase the window covers."""
        return self.leave_deg - self.enter_deg

    @property
    def climb(self) -> float:
        """How far the bolt climbs from its lowest height to the exit."""
        return self.leave_height - self.lowest_height


def windows_of(pair: Pair, history: SolvedHistory) -> tuple[Window, ...]:
    """The clearance windows of a history in order of their entries; none where a thread is never touched first.

    An undecided stretch between two parts of a window belongs to it.
    """
    inside = _inside(history.intervals)
    if all(inside) or not any(inside):
        return ()
    count = len(inside)
    windows = []
    for entry in (i for i in range(count) if inside[i] and not inside[i - 1]):
        length = next(n for n in range(1, count) if not inside[(entry + n) % count])
        windows.append(_window(pair, history, [(entry + n) % count for n in range(length + 1)]))
    return tuple(windows)


def _inside(intervals: Sequence[Interval]) -> list[bool]:
    """Whether each interval is part of a window."""
    decided = [_within_thread(interval) for interval in intervals]
    count = len(decided)
    return [
        decided[i] or (intervals[i].state is None and decided[i - 1] and decided[(i + 1) % count]) for i in range(count)
    ]


def _within_thread(interval: Interval) -> bool:
    state = interval.state
    if state is None:
        return False
    first = state.contacts[0]
    if first.features is FeaturePair.FLUSH:
        return _height(state) < 0.0
    return first.features in WITHIN_THREAD


def _window(pair: Pair, history: SolvedHistory, cut: list[int]) -> Window:
    """The window between the first and the last of consecutive boundaries, from their numbers."""
    boundaries = [history.boundaries[i] for i in cut]
    intervals = [history.intervals[i] for i in cut[:-1]]
    enter, leave = boundaries[0], boundaries[-1]
    start = enter.phase_deg
    within = [(boundary.high_deg, boundary.after) for boundary in boundaries[:-1]]
    within += [(interval.middle_deg, interval.state) for interval in intervals]
    within += [(boundary.low_deg, boundary.before) for boundary in boundaries[1:]]
    heights = [(_height(state), _later(phase, start)) for phase, state in within if state is not None]
    lowest, lowest_deg = min(heights)
    return Window(
        enter_deg=start,
        leave_deg=_later(leave.phase_deg, start),
        enter_height=_known(limit_before(pair, history, cut[0]), limit_after(pair, history, cut[0])).height,
        leave_height=_known(limit_after(pair, history, cut[-1]), limit_before(pair, history, cut[-1])).height,
        lowest_deg=lowest_deg,
        lowest_height=lowest,
        courses=_courses(boundaries, intervals, start, HEIGHT_JUMP * pair.thread_pitch),
    )


def _courses(
    boundaries: list[Boundary], intervals: list[Interval], start_deg: float, least_jump: float
) -> tuple[Course, ...]:
    courses: list[Course] = []
    for interval, opening, closing in zip(intervals, boundaries[:-1], boundaries[1:], strict=True):
        if interval.state is None:
            continue
        first, last = _known(opening.after, interval.state), _known(closing.before, interval.state)
        course = Course(
            interval.state.contacts[0].features,
            _later(opening.phase_deg, start_deg),
            _later(closing.phase_deg, start_deg),
            _height(first),
            _height(last),
        )
        if (
            courses
            and courses[-1].features is course.features
            and courses[-1].end_deg == course.start_deg
            and abs(course.start_height - courses[-1].end_height) <= least_jump
        ):
            courses[-1] = replace(courses[-1], end_deg=course.end_deg, end_height=course.end_height)
        else:
            courses.append(course)
    return tuple(courses)


Known = TypeVar("Known")


def _known(side: Known | None, instead: Known | None) -> Known:
    """What is known of a side of a boundary, or of the other one where it is undecided."""
    known = side or instead
    assert known is not None, "both sides of a boundary are undecided"
    return known


def _height(state: ContactState) -> float:
    return state.poses[0].translation[2]


def _later(phase_deg: float, start_deg: float) -> float:
    """The phase, in [0, 360], or one turn later where it is less than the start."""
    return phase_deg if phase_deg >= start_deg else phase_deg + CIRCLE_DEG
