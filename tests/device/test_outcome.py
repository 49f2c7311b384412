"""How paths end: the rules of the table, on paths that are made up point by point."""

from __future__ import annotations

import math

import pytest

from oracle.pose import pose_rotation
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPoint, Held
from threadstate.device.assembly_outcome import Ending, allowed_tilt_deg, lead_margin, outcome_of, play_margin
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.state.model import StagePose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits

UNC = quarter_twenty_unc()
LEFT = pair_by_designation("M6x1-6g/6H LH")
P = UNC.thread_pitch
DOWN, UP = axial_limits(UNC)
DEVICE = default_device().in_unit(UNC.unit)


def point(
    phase_deg: float, height: float, *, x: float = 0.0, roll_deg: float = 0.0, torque: float = 0.0
) -> AssemblyPoint:
    """A point of a path; the bolt turns with the command."""
    rotation = pose_rotation(roll_deg, 0.0, phase_deg)
    rows = tuple(tuple(float(number) for number in row) for row in rotation)
    pose = StagePose(rows, (x, 0.0, height))  # type: ignore[arg-type]
    return AssemblyPoint(phase_deg, Held.CONTACTS, pose, (x, 0.0, 0.0), (0.0, 0.0, 0.0), (), torque, 0.0, 0.0)


def turned(above: float, *, rate: float = 1.0, roll_deg: float = 0.0) -> list[AssemblyPoint]:
    """A clockwise turn of 270 deg that follows the lead at a rate, so far above the lower limit in phase at its end."""
    end = -DOWN - 0.75 * P + above
    return [
        point(phase, end + rate * P * (phase + 270.0) / 360.0, roll_deg=roll_deg)
        for phase in (-270.0 * i / 90 for i in range(91))
    ]


@pytest.mark.parametrize(
    ("above", "rate", "roll_deg", "outcome"),
    [
        (0.0, 1.0, 0.0, AssemblyOutcome.ENGAGED),
        (DOWN + UP, 0.96, 0.0, AssemblyOutcome.ENGAGED),
        (DOWN + UP, 1.06, 0.0, AssemblyOutcome.IDLE),
        (0.0, 0.0, 0.0, AssemblyOutcome.IDLE),
        (0.5 * P, 1.0, 0.0, AssemblyOutcome.CROSS_THREADED),
        (-2e-3 * P, 1.0, 0.0, AssemblyOutcome.CROSS_THREADED),
        (0.0, 1.0, 3.0, AssemblyOutcome.CROSS_THREADED),
    ],
)
def test_a_clockwise_turn(above: float, rate: float, roll_deg: float, outcome: AssemblyOutcome) -> None:
    found, margins = outcome_of(UNC, DEVICE, Strategy.CW, Ending.TURNED, [turned(above, rate=rate, roll_deg=roll_deg)])
    assert found is outcome
    assert margins.lead is not None
    assert margins.lead == pytest.approx(0.05 - abs(rate - 1.0), abs=1e-9)
    assert margins.snap is None


@pytest.mark.parametrize("first_deg", [0.3, 0.0, -0.4])
@pytest.mark.parametrize("step_deg", [0.5, 1.0, 1.7, 2.0, 40.0])
@pytest.mark.parametrize("pair", [UNC, LEFT])
def test_where_the_points_of_a_turn_lie_does_not_matter(pair: Pair, first_deg: float, step_deg: float) -> None:
    sign = math.copysign(1.0, pair.lead)
    count = math.ceil((270.0 + first_deg) / step_deg)
    phases = [first_deg - step_deg * i for i in range(count)] + [-270.0]
    points = [point(sign * phase, abs(pair.lead) * 1.04 * (phase + 270.0) / 360.0) for phase in phases]
    assert lead_margin(pair, points) == pytest.approx(0.01, abs=1e-12)


@pytest.mark.parametrize(
    ("roll_deg", "pitch_deg", "phase_deg"),
    [(0, -3, 118.125), (-1, -4, 118.125), (-1, -1, 123.75), (1, -2, 118.125), (2, -2, 118.125), (3, -2, 118.125)],
)
def test_paths_that_all_but_follow_the_lead_end_alike_with_any_step(
    roll_deg: float, pitch_deg: float, phase_deg: float
) -> None:
    """Beside boundaries of success maps: they miss the lead by some 1e-3 of what is allowed."""
    paths = [
        assemble_pose(UNC, roll_deg, pitch_deg, phase_deg, strategy=Strategy.CW, longest_step=step)
        for step in (2.0, 1.0, 0.5)
    ]
    assert {path.outcome for path in paths} == {AssemblyOutcome.IDLE}
    margins = [path.margins.lead for path in paths if path.margins is not None and path.margins.lead is not None]
    assert len(margins) == 3
    assert max(margins) - min(margins) < 5e-5


@pytest.mark.parametrize("turns", range(4))
def test_the_play_repeats_with_the_thread(turns: int) -> None:
    middle = point(30.0, UNC.lead * 30.0 / 360.0 - DOWN + 0.5 * (DOWN + UP) - turns * P).pose
    assert play_margin(UNC, middle) == pytest.approx(0.5 * (DOWN + UP) + 1e-3 * P)


def test_the_tilt_that_the_play_allows_is_less_deeper_down() -> None:
    deep, shallow, out = (point(0.0, height).pose for height in (-2.0 * P, -0.5 * P, 0.0))
    assert allowed_tilt_deg(UNC, deep) == pytest.approx(math.degrees((DOWN + UP) / UNC.nut.minor_diameter), rel=1e-4)
    assert allowed_tilt_deg(UNC, shallow) == pytest.approx(2.0 * allowed_tilt_deg(UNC, deep))
    assert allowed_tilt_deg(UNC, out) == 0.0


def test_other_ends() -> None:
    level = [point(phase, 0.0, x=0.01, torque=0.5) for phase in (0.0, 1.0, 2.0)]
    for ending, outcome in (
        (Ending.SLIPPED, AssemblyOutcome.SLIPPED),
        (Ending.TORQUE, AssemblyOutcome.JAMMED),
        (Ending.TRAVEL, AssemblyOutcome.OVER_TRAVEL),
        (Ending.FAILED, AssemblyOutcome.UNDECIDED),
        (Ending.TURNED, AssemblyOutcome.NO_SNAP),
    ):
        found, margins = outcome_of(UNC, DEVICE, Strategy.CCW_THEN_CW, ending, [level])
        assert found is outcome
        assert margins.torque == pytest.approx(20.0 - 0.5 / (DEVICE.push * UNC.nominal_diameter / 2.0))
        assert margins.offset == pytest.approx(UNC.bolt.major_diameter / 2.0 - 0.01)
        assert margins.snap == pytest.approx(-0.05 * P)


def test_a_snap_is_a_descent_within_three_degrees() -> None:
    slow = [point(float(phase), -2e-4 * phase) for phase in range(30)]
    fast = [*slow, point(31.0, slow[-1].pose.translation[2] - 0.06 * P)]
    for points, margin in ((slow, 6e-4 - 0.05 * P), (fast, 0.01 * P + 2e-4)):
        _, margins = outcome_of(UNC, DEVICE, Strategy.CCW_THEN_CW, Ending.TURNED, [points])
        assert margins.snap == pytest.approx(margin)
