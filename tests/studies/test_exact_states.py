"""Exact states: they have the check values of the method and its laws, and the solver's states agree with them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx

from studies.certificate import states
from studies.certificate.exact import PRECISION, ExactState, UncoveredError, exact_state, stage_from_record
from studies.certificate.states import KINDS, QUANTITIES, Comparison, compared, errors, random_poses, row
from tests.contact.samples import Floats
from threadstate.contact import _record_kernel as rk
from threadstate.contact._solve_kernel import NONE_BESIDE, solve_rows
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options, solve_records
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair

UNC = pair_by_designation("1/4-20 UNC")
ACME = "1/4-16 ACME-2G at minimum material"
SHARP = "1/4-16 ACME-2G with sharp corners"

ROUND_OFF = 1e-14
"""Heights and places in thread pitches, and turns in rad: some tens of units in the last place."""
AT_A_FILLET = 1e-11
"""Third turns (rad) about an axis through two contacts that are a hundredth of a thread pitch apart."""


def record_of(pair: Pair, *pose_deg: float) -> Floats:
    """The solver's record of one pose."""
    records: Floats = solve_records(pair, SolveOptions(), np.array([pose_deg]))
    return records[0]


def solved(pair: Pair, *pose_deg: float) -> tuple[ExactState, Floats]:
    """The exact state of a pose and the solver's record."""
    record = record_of(pair, *pose_deg)
    return exact_state(pair, np.array(pose_deg), record), record


def test_check_values_of_the_method() -> None:
    exact, _ = solved(UNC, 1.0, -2.0, 10.0)
    second, third = (math.degrees(float(turn)) for turn in exact.turns if turn is not None)
    assert float(exact.height) == pytest.approx(0.001127350432, abs=1e-12)
    assert second == pytest.approx(1.697903289, abs=1e-9)
    assert third == pytest.approx(1.216002530, abs=1e-9)
    points = [[float(one) for one in contact.point] for contact in exact.contacts]
    expected = [
        (0.048928846, -0.114408383, 0.0),
        (0.063357172, 0.075488949, 0.0),
        (-0.003085933, -0.124432977, -0.003361432),
    ]
    np.testing.assert_allclose(points, expected, atol=1e-8)


def test_edges_are_refined_from_a_doubtful_onset_on() -> None:
    """Two edges cross at the end of the second turn, of 4 deg: sums of doubles tell that they touch, and when."""
    pose_deg = np.array([4.0, -4.0, 22.5])
    record = np.empty((1, rk.RECORD_SIZE))
    both = UNC.bolt.packed, UNC.nut.packed
    boxes = solve_rows(np.radians([pose_deg]), packed_options(UNC, SolveOptions()), *both, NONE_BESIDE, record)
    exact = exact_state(UNC, pose_deg, record[0])
    for turn, column in zip(exact.turns, (rk.O_LAMBDA, rk.O_MU), strict=True):
        assert turn is not None
        assert abs(float(turn - record[0, column])) < ROUND_OFF
    # Refined from its beginning on the turn alone has 1,400.
    assert boxes < 3000


def test_a_bolt_that_comes_to_lie_flush_turns_by_its_tilt() -> None:
    exact, _ = solved(UNC, 4.0, 0.0, 185.0)
    turn, absent = exact.turns
    assert absent is None and turn is not None
    with ctx.workprec(PRECISION):
        assert turn.overlaps(arb.pi() / 45)
        assert float(turn.rad()) < 1e-50


def test_a_left_hand_pair_is_the_mirror_image() -> None:
    exact, _ = solved(pair_by_designation("M6"), 1.0, -2.0, 10.0)
    mirrored, _ = solved(pair_by_designation("M6x1-6g/6H LH"), -1.0, -2.0, -10.0)
    assert exact.height.overlaps(mirrored.height)
    for turn, mirrored_turn in zip(exact.turns, mirrored.turns, strict=True):
        assert turn is not None and mirrored_turn is not None and turn.overlaps(mirrored_turn)
    for contact, other in zip(exact.contacts, mirrored.contacts, strict=True):
        x, y, z = contact.point
        assert x.overlaps(other.point[0]) and y.overlaps(-other.point[1]) and z.overlaps(other.point[2])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("designation", ["1/4-20 UNC", "M6", SHARP])
def test_states_agree_with_exact_ones(kind: str, designation: str) -> None:
    poses = random_poses(kind, 3)
    found = compared(designation, poses, solve_records(pair_by_designation(designation), SolveOptions(), poses))
    assert len(found.errors["height"]) == 3
    for name in QUANTITIES:
        assert max(found.errors.get(name, [0.0])) < ROUND_OFF, name


@pytest.mark.parametrize(
    ("designation", "pose_deg"),
    [
        ("1/4-20 UNC", (-7.26815238e-07, 1.62674637e-05, -0.431328931)),
        ("1/4-20 BSW", (-3.26533720e-06, 1.52389788e-05, 1.84306219)),
        ("M6", (8.71278941e-05, 1.31197870e-04, 2.57874449)),
        (ACME, (3.81041545e-07, 1.52228179e-06, 0.923562516)),
    ],
)
def test_a_second_contact_beside_the_first_costs_the_third_turn_no_digits(
    designation: str, pose_deg: tuple[float, float, float]
) -> None:
    pair = pair_by_designation(designation)
    exact, record = solved(pair, *pose_deg)
    first, second = (np.array([float(one) for one in contact.point]) for contact in exact.contacts[:2])
    assert np.linalg.norm(second - first) < 0.5 * pair.thread_pitch
    found = errors(pair, exact, record)
    assert found["second place"] < AT_A_FILLET
    assert found["third turn"] < AT_A_FILLET
    # What doubles between the stages would cost: the solver does not go on from the record's own numbers.
    contact, _ = stage_from_record(pair, record, 2)
    lost = max(abs(float(a - b)) for a, b in zip(contact.point, exact.contacts[1].point, strict=True))
    assert lost > 1e3 * found["second place"] * pair.thread_pitch


@pytest.mark.parametrize(
    ("column", "number", "reason"),
    [
        (rk.O_STATUS, 1.0, "unresolved"),
        (rk.O_FLAGS, rk.FLAG_TIE, "simultaneous"),
        (rk.O_CONTACT + rk.P_PAIR, 7.0, "level"),
    ],
)
def test_what_is_not_covered_is_said(column: int, number: float, reason: str) -> None:
    record = record_of(UNC, 1.0, -2.0, 10.0)
    record[column] = number
    with pytest.raises(UncoveredError, match=reason):
        exact_state(UNC, np.array([1.0, -2.0, 10.0]), record)


def test_the_first_contact_does_not_pass_for_the_second() -> None:
    record = record_of(UNC, 1.0, -2.0, 10.0)
    first = record[rk.O_CONTACT : rk.O_CONTACT + rk.POINT_SIZE].copy()
    record[rk.O_CONTACT + rk.POINT_SIZE : rk.O_CONTACT + 2 * rk.POINT_SIZE] = first
    with pytest.raises(UncoveredError, match=r"singular|settle|proved"):
        exact_state(UNC, np.array([1.0, -2.0, 10.0]), record)


def test_an_error_is_measured() -> None:
    pose: Floats = np.array([1.0, -2.0, 10.0])
    exact, record = solved(UNC, *pose)
    record[rk.O_MU] += 1e-9
    record[rk.O_CONTACT + rk.P_POINT] += 1e-8
    found = errors(UNC, exact, record)
    assert found["third turn"] == pytest.approx(1e-9, rel=1e-4)
    assert found["first place"] == pytest.approx(1e-8 / UNC.thread_pitch, rel=1e-4)


def test_the_table_says_what_was_left_out() -> None:
    found = Comparison()
    poses = np.array([[1.0, -2.0, 10.0], [0.0, 0.0, 180.0]])
    for pose, record in zip(poses, solve_records(UNC, SolveOptions(), poses), strict=True):
        found.add(UNC, pose, record)
    line = row("two poses", found)
    assert line.startswith("| two poses | 1 |")
    assert "1 the bolt is level" in line


def test_the_command_prints_a_row_for_each_pair_and_kind(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def records_of(checkout: Path, poses: dict[str, Floats]) -> dict[str, Floats]:
        shift = 1e-6 if checkout == tmp_path else 0.0
        records = {name: solve_records(UNC, SolveOptions(), asked) for name, asked in poses.items()}
        for some in records.values():
            some[:, rk.O_POSE + 11] += shift
        return records

    monkeypatch.setattr(states, "records_of", records_of)
    monkeypatch.setattr("sys.argv", ["states", "--poses", "1", "--pairs", "1/4-20 UNC", "--beside", str(tmp_path)])
    states.main()
    _, _, *rows = capsys.readouterr().out.splitlines()
    expected = [f"1/4-20 UNC, {kind}" for kind in KINDS]
    assert [one.split(" | ")[0].removeprefix("| ") for one in rows] == [
        *expected,
        *(f"{name}, {tmp_path}" for name in expected),
    ]
    assert all(float(one.split(" | ")[2]) < ROUND_OFF for one in rows[:3])
    assert all(float(one.split(" | ")[2]) == pytest.approx(2e-5, rel=0.05) for one in rows[3:])
