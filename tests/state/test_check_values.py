"""The check values of the method's section 7, to their printed digits."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from threadstate.state.model import FeaturePair, Flag, Vector
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

HEIGHT_DIGITS_INCH = 0.6e-12
POINT_DIGITS_INCH = 1e-8
"""The table's points of smooth contacts were placed by their heights: to the root of round-off, not to all digits."""
TURN_DIGITS_DEG = 1e-9

PAIR = quarter_twenty_unc()


@dataclass(frozen=True)
class Row:
    """A row of the table: heights and points in inches, angles in degrees; None where it is empty."""

    pose: tuple[float, float, float]
    height: float
    first: Vector
    lambda_deg: float | None = None
    second: Vector | None = None
    mu_deg: float | None = None
    third: Vector | None = None


ROWS = [
    Row((4, 0, 185), 0.008681193158, (-0.010820115, 0.123674429, 0.0), 4.0),
    Row((0, -4, 0), -0.003070141635, (-0.025731627, -0.121745498, -0.004869472)),
    Row(
        (-4, 0, 131),
        0.002830893654,
        (-0.092371859, 0.044554317, 0.0),
        1.678293607,
        (0.104932854, -0.045557091, 0.0),
        4.586498646,
        (-0.109348954, -0.006112413, 0.0),
    ),
    Row(
        (1, -2, 10),
        0.001127350432,
        (0.048928846, -0.114408383, 0.0),
        1.697903289,
        (0.063357172, 0.075488949, 0.0),
        1.216002530,
        (-0.003085933, -0.124432977, -0.003361432),
    ),
    Row(
        (0, 3, 250),
        0.004929945576,
        (-0.097292174, -0.064694647, 0.0),
        2.474133102,
        (0.080957333, 0.058962653, 0.0),
        4.828627189,
        (0.050144651, -0.113803892, 0.0),
    ),
]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: str(row.pose))
def test_check_values(row: Row) -> None:
    state = solve_pose(PAIR, *row.pose)
    assert state.poses[0].translation[2] == pytest.approx(row.height, abs=HEIGHT_DIGITS_INCH)
    assert state.contacts[0].point == pytest.approx(row.first, abs=POINT_DIGITS_INCH)
    if row.lambda_deg is not None:
        assert state.lambda_deg == pytest.approx(row.lambda_deg, abs=TURN_DIGITS_DEG)
    if row.second is not None:
        assert state.contacts[1].point == pytest.approx(row.second, abs=POINT_DIGITS_INCH)
    if row.mu_deg is not None:
        assert state.mu_deg == pytest.approx(row.mu_deg, abs=TURN_DIGITS_DEG)
    if row.third is not None:
        assert state.contacts[2].point == pytest.approx(row.third, abs=POINT_DIGITS_INCH)


def test_the_first_row_ends_flush() -> None:
    state = solve_pose(PAIR, 4, 0, 185)
    assert state.flags == (Flag.FLUSH,)
    assert {contact.features for contact in state.contacts[1:]} == {FeaturePair.FLUSH}


def test_the_jump_of_section_6() -> None:
    before, after = (solve_pose(PAIR, 0, -4, phase).poses[0].translation[2] for phase in (357, 358))
    assert before == pytest.approx(0.0061, abs=0.6e-4)
    assert after == pytest.approx(-0.0033, abs=0.6e-4)
