"""Descents, steepest falls and snaps: of curves in closed form, and of the bolt beside scans of its states."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.history.build import histories_of
from threadstate.history.descents import LEAST_FALL, _Steepest, falls_of
from threadstate.history.falls import SNAP_PITCHES, Falls
from threadstate.history.height_curve import Gap, HeightCurve, Segment, height_curve, monotone_segments
from threadstate.history.records import RecordStore
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.play import axial_play

PAIR = quarter_twenty_unc()
P = PAIR.thread_pitch
Floats = NDArray[np.float64]


def lines(*points: tuple[float, float], undecided: tuple[int, ...] = ()) -> HeightCurve:
    """Straight lines from point to point, the last a turn after the first; two points of one phase are a jump.

    ``undecided`` are numbers of lines that nothing is known of.
    """
    phases, heights = (np.array(column) for column in zip(*points, strict=True))
    known = [i for i in range(len(points) - 1) if phases[i] < phases[i + 1] and i not in undecided]
    segments = [
        Segment(float(phases[i]), float(phases[i + 1]), float(heights[i]), float(heights[i + 1])) for i in known
    ]
    gaps = []
    for number, segment in enumerate(segments):
        before = segments[number - 1]
        end = before.end_deg - (360.0 if number == 0 else 0.0)
        jumps = end == segment.start_deg and before.end_height != segment.start_height
        gaps.append(
            Gap(
                end,
                segment.start_deg,
                before.end_height,
                segment.start_height,
                jumps=jumps,
                undecided=end < segment.start_deg,
            )
        )

    def line_at(phase: float) -> tuple[Segment, float]:
        turned = (phase - phases[0]) % 360.0 + phases[0]
        return next((one, turned) for one in segments if one.start_deg <= turned <= one.end_deg)

    def rate(one: Segment) -> float:
        return (one.end_height - one.start_height) / (one.end_deg - one.start_deg)

    def height(at: Floats) -> Floats:
        return np.array([one.start_height + rate(one) * (t - one.start_deg) for one, t in map(line_at, at)])

    def slope(at: Floats) -> Floats:
        return np.array([rate(one) for one, _ in map(line_at, at)])

    return HeightCurve(tuple(segments), tuple(gaps), height, slope, 1e-12)


def wave(amplitude: float, periods: int) -> HeightCurve:
    """A cosine of so many periods a turn."""

    def height(at: Floats) -> Floats:
        return amplitude * np.cos(np.radians(periods * np.asarray(at)))

    def slope(at: Floats) -> Floats:
        return -math.radians(periods) * amplitude * np.sin(np.radians(periods * np.asarray(at)))

    segments = monotone_segments(height, slope, 20.0, 380.0)
    gaps = [Gap(one.start_deg, one.start_deg, one.start_height, one.start_height) for one in segments]
    return HeightCurve(tuple(segments), tuple(gaps), height, slope, 1e-12)


def summary(falls: Falls) -> list[tuple[float, float, object]]:
    return [(one.start_deg, one.end_deg, pytest.approx(one.fall, abs=1e-12)) for one in falls.descents]


def test_level_stretches_belong_to_a_descent_between_falls_and_not_at_its_ends() -> None:
    falls = falls_of(lines((0, 0), (50, 1), (100, 1), (101, 0.7), (110, 0.7), (111, 0.2), (200, 0.2), (360, 0)), 1.0)
    assert summary(falls) == [(100.0, 360.0, 1.0)]
    falls = falls_of(lines((0, 0), (50, 1), (100, 1), (101, 0.7), (110, 0.7), (111, 0.0), (360, 0)), 1.0)
    assert summary(falls) == [(100.0, 111.0, 1.0)]
    assert falls.steepest is not None
    assert falls.steepest.fall == pytest.approx(0.7)
    assert falls.steepest.start_deg == 110.0


def test_a_rise_ends_a_descent_however_small_it_is() -> None:
    falls = falls_of(lines((0, 1), (10, 0.6), (10.001, 0.6 + 1e-9), (20, 0.1), (360, 1)), 1.0)
    assert summary(falls) == [(0.0, 10.0, 0.4), (10.001, 20.0, 0.5 + 1e-9)]


def test_a_fall_below_what_counts_is_no_descent() -> None:
    assert falls_of(lines((0, 0.0), (10, 0.9 * LEAST_FALL), (20, 0.0), (360, 0.0)), 1.0) == Falls((), None)
    assert len(falls_of(lines((0, 0.0), (10, 1.1 * LEAST_FALL), (20, 0.0), (360, 0.0)), 1.0).descents) == 1


def test_what_is_level_throughout_has_no_falls() -> None:
    assert falls_of(lines((0, 0.3), (100, 0.3), (360, 0.3)), 1.0) == Falls((), None)
    assert falls_of(HeightCurve((), (), wave(1.0, 1).height, wave(1.0, 1).slope, 1e-12), 1.0) == Falls((), None)


def test_a_descent_over_phase_0_ends_above_360() -> None:
    falls = falls_of(lines((-2, 1), (-1, 1), (2, 0.4), (100, 0.4), (358, 1)), 1.0)
    assert summary(falls) == [(359.0, 362.0, 0.6)]
    assert falls.steepest is not None
    assert falls.steepest.start_deg == 359.0


def test_jumps_are_parts_of_a_descent() -> None:
    falls = falls_of(lines((0, 1), (10, 0.9), (10, 0.5), (20, 0.4), (20, 0.3), (360, 1)), 1.0)
    (descent,) = falls.descents
    assert summary(falls) == [(0.0, 20.0, 0.7)]
    assert [jump.phase_deg for jump in descent.jumps] == [10.0, 20.0]
    assert [jump.fall for jump in descent.jumps] == pytest.approx([0.4, 0.1])
    assert descent.largest_jump == descent.jumps[0]
    alone = falls_of(lines((0, 0), (180, 1), (180, 0), (360, 0)), 1.0)
    assert summary(alone) == [(180.0, 180.0, 1.0)]
    upwards = falls_of(lines((0, 1), (10, 0.5), (10, 0.8), (20, 0.2), (360, 1)), 1.0)
    assert summary(upwards) == [(0.0, 10.0, 0.5), (10.0, 20.0, pytest.approx(0.6))]


def test_an_undecided_stretch_is_passed_over_and_counted() -> None:
    falls = falls_of(lines((0, 1), (10, 0.9), (12, 0.5), (20, 0.4), (360, 1), undecided=(1,)), 1.0)
    (descent,) = falls.descents
    assert (descent.start_deg, descent.end_deg, descent.undecided_deg) == (0.0, 20.0, 2.0)
    assert descent.jumps == ()


def test_the_snap_is_the_descent_of_the_steepest_fall_if_that_is_large_enough() -> None:
    # A long gentle descent goes farther down than a short steep one.
    falls = falls_of(lines((0, 1), (100, 0), (200, 0.8), (201, 0.3), (360, 1)), 1.0)
    assert falls.steepest is not None
    assert (falls.steepest.descent, falls.steepest.start_deg) == (1, 200.0)
    assert falls.steepest.fall == pytest.approx(0.5)
    assert falls.snap(0.49) == falls.descents[1]
    assert falls.snap(0.51) is None


@pytest.mark.parametrize("span", [3.0, 10.0, 45.0])
def test_the_steepest_fall_of_a_wave_lies_in_the_middle_of_its_descent(span: float) -> None:
    falls = falls_of(wave(0.25, 4), 1.0, span)
    assert [round(one.start_deg, 6) for one in falls.descents] == [0.0, 90.0, 180.0, 270.0]
    assert [one.fall for one in falls.descents] == pytest.approx([0.5] * 4, abs=1e-12)
    assert falls.steepest is not None
    assert falls.steepest.fall == pytest.approx(0.5 * math.sin(math.radians(2.0 * span)), abs=1e-12)
    assert falls.steepest.start_deg % 90.0 == pytest.approx(22.5 - 0.5 * span, abs=1e-6)


def test_extremes_are_found_where_the_slope_changes_its_sign() -> None:
    segments = wave(1.0, 3).segments
    ends = [one.end_deg for one in segments[:-1]]
    assert ends == pytest.approx([60.0, 120.0, 180.0, 240.0, 300.0, 360.0], abs=2e-9)


@pytest.mark.parametrize(("roll", "pitch"), [(0.0, -4.0), (-4.0, -4.0), (4.0, 0.0), (2.5, -1.2), (-2.0, 1.0)])
def test_falls_are_those_of_a_scan(roll: float, pitch: float) -> None:
    falls = falls_of(height_curve(PAIR, roll, pitch), P)
    assert falls.steepest is not None
    descent = falls.descents[falls.steepest.descent]
    step = 0.05
    first, last = (math.floor(descent.start_deg / step) - 80, math.ceil(descent.end_deg / step) + 80)
    numbers = np.arange(first, last + 1)[:: 1 + (last - first) // 800]
    phases = numbers * step
    heights = np.array([one.poses[0].translation[2] for one in solve_poses(PAIR, [(roll, pitch, x) for x in phases])])
    within = (phases >= descent.start_deg) & (phases <= descent.end_deg)
    assert (np.diff(heights[within]) <= falls.descents[0].fall * 1e-9).all()
    # Outside the height does not go on falling: it is level there, or higher inside.
    beside = 1.0
    before = (phases < descent.start_deg) & (phases > descent.start_deg - beside)
    after = (phases > descent.end_deg) & (phases < descent.end_deg + beside)
    assert heights[before].max() <= descent.start_height + 1e-12
    assert heights[after].min() >= descent.end_height - descent.fall_error
    lags = np.arange(1, round(3.0 / (phases[1] - phases[0])) + 1)
    scanned = max(float((heights[:-lag] - heights[lag:]).max()) for lag in lags)
    assert scanned <= falls.steepest.fall + 1e-12
    slope = float(np.abs(np.diff(heights))[np.abs(np.diff(heights)) < 2e-4].max())
    assert falls.steepest.fall - scanned <= 2.0 * slope + 1e-9


def test_the_falls_that_a_designer_asked_for() -> None:
    """Roll 0, pitch -4: 0.0110 in, of which 0.0075 in at one phase; roll and pitch -4: 0.0093 in within 3 deg."""
    jumping = falls_of(height_curve(PAIR, 0.0, -4.0), P)
    snap = jumping.snap(SNAP_PITCHES * P)
    assert snap is not None
    assert snap.largest_jump is not None
    assert (round(snap.fall, 4), round(snap.largest_jump.fall, 4)) == (0.0110, 0.0075)
    gliding = falls_of(height_curve(PAIR, -4.0, -4.0), P)
    assert gliding.steepest is not None
    assert round(gliding.steepest.fall, 4) == 0.0093
    snap = gliding.snap(SNAP_PITCHES * P)
    assert snap is not None
    assert snap.jumps == ()
    assert snap.fall >= gliding.steepest.fall


def test_a_level_bolt_falls_by_twice_its_play() -> None:
    falls = falls_of(height_curve(PAIR, 0.0, 0.0), P)
    (descent,) = falls.descents
    play = axial_play(PAIR)
    assert descent.fall == pytest.approx(2.0 * play, abs=1e-10)
    assert descent.start_deg == pytest.approx(360.0 * (1.0 - play / P), abs=3e-7)
    assert falls.snap(SNAP_PITCHES * P) is None


def test_known_poses_change_no_bit() -> None:
    options = SolveOptions()
    store = RecordStore(PAIR, options)
    histories_of(PAIR, [(0.0, -4.0)], options, store=store)
    assert falls_of(height_curve(PAIR, 0.0, -4.0, options, store), P) == falls_of(height_curve(PAIR, 0.0, -4.0), P)


class Doubtful(RecordStore):
    """Records of which those in a stretch of phase, which may hold phase 0, are undecided."""

    def __init__(self, start_deg: float, width_deg: float) -> None:
        super().__init__(PAIR, SolveOptions())
        self._start, self._width = start_deg, width_deg

    def records(self, poses_deg: Floats) -> Floats:
        found = super().records(poses_deg).copy()
        found[(poses_deg[:, 2] - self._start) % 360.0 < self._width, rk.O_STATUS] = 1.0
        return found


@pytest.mark.parametrize("start", [100.25, 355.25])
def test_an_undecided_stretch_is_a_gap_wherever_it_lies(start: float) -> None:
    roll, pitch = -4.0, 2.0
    curve = height_curve(PAIR, roll, pitch, store=Doubtful(start, 10.0))
    (gap,) = (gap for gap in curve.gaps if gap.undecided)
    assert gap.start_deg % 360.0 == pytest.approx(start, abs=2e-3)
    assert gap.end_deg - gap.start_deg == pytest.approx(10.0, abs=4e-3)
    assert 0.0 <= curve.segments[0].start_deg < 360.0
    for one, gap in zip(curve.segments, (*curve.gaps[1:], curve.gaps[0]), strict=True):
        assert one.end_deg == pytest.approx(gap.start_deg, abs=1e-6) or one.end_deg - 360.0 == pytest.approx(
            gap.start_deg, abs=1e-6
        )
    known, whole = falls_of(curve, P), falls_of(height_curve(PAIR, roll, pitch), P)
    if start < 300.0:
        # The one descent passes over it, from phase 71 to 233.
        assert [one.fall for one in known.descents] == [one.fall for one in whole.descents]
        assert known.descents[0].undecided_deg == pytest.approx(10.0, abs=4e-3)


def test_an_orientation_without_any_decided_pose_has_no_curve() -> None:
    curve = height_curve(PAIR, -4.0, 2.0, store=Doubtful(0.0, 360.0))
    assert (curve.segments, curve.gaps) == ((), ())
    assert falls_of(curve, P) == Falls((), None)


def test_slopes_are_those_of_the_heights() -> None:
    curve = height_curve(PAIR, -2.0, 1.0)
    step = 1e-5
    for one in curve.segments:
        middle = 0.5 * (one.start_deg + one.end_deg)
        if one.end_deg - one.start_deg > 0.1:
            low, high = curve.height(np.array([middle - step, middle + step]))
            assert (high - low) / (2.0 * step) == pytest.approx(curve.slope(np.array([middle]))[0], abs=1e-10)
            assert min(one.start_height, one.end_height) - 1e-15 <= low <= max(one.start_height, one.end_height) + 1e-15


def test_a_fall_that_is_as_large_by_round_off_leaves_no_stretch_out() -> None:
    """The first stretch offers a fall that is less by 9e-13, within less; the bound of the second is in between."""
    span, round_off = 3.0, 1e-12
    known = {5.0: 2.0, 5.125: 1.9, 8.0: 1.1, 8.125: 1.0 - 0.5 * round_off}
    heights = {1.0: 2.0, 1.125: 1.9, 4.0: 1.1, 4.125: 0.95, **known}

    def height(phases: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.array([heights.get(one, 2.0 if one < span else 1.0 + 0.9 * round_off) for one in phases.tolist()])

    def slope(phases: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(phases < span, 1.0625 - phases, 0.0)

    search = _Steepest(HeightCurve((), (), height, slope, round_off), span)
    search._fall, search._start, search._end = 1.0, 1.4, 1.4 + span
    search._within([(1.0, 1.125), (5.0, 5.125)])
    assert search._fall == pytest.approx(1.0 - 0.9 * round_off, abs=1e-15)
