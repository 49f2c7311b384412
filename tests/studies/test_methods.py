"""The methods behind their protocol: the same cases, states or refusals with a reason."""

from __future__ import annotations

import pickle
from dataclasses import replace

import pytest

from studies.methods import (
    Case,
    ExactMethod,
    MeshStates,
    Method,
    Refusal,
    between,
    moved,
    same_input,
    scaled,
    with_dimensions,
)
from tests.studies.states import PAIR, THREE_POINT
from threadstate.mesh.options import Descent
from threadstate.mesh.presets import Preset
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose

pytestmark = pytest.mark.slow

COARSE = MeshStates(Preset.COARSE, Descent.DECADES)


@pytest.mark.parametrize("method", [ExactMethod(), COARSE], ids=lambda method: method.name)
def test_answers_come_in_the_order_of_the_cases_and_refusals_say_why(method: Method) -> None:
    poses = [THREE_POINT, (0.0, 0.0, 180.0), (2.0, 1.0, 100.0)]
    other = replace(PAIR, thread_pitch=PAIR.thread_pitch * 1.001)
    cases = [*(Case(PAIR, pose) for pose in poses), Case(other, poses[0]), Case(PAIR, (0.5, 0.25, 33.0))]
    answers = pickle.loads(pickle.dumps(method)).answers(cases)
    assert len(answers) == len(cases)
    for case, answer in zip(cases, answers, strict=True):
        if isinstance(answer, Refusal):
            assert answer.reason
        else:
            assert (answer.roll_deg, answer.pitch_deg, answer.phase_deg) == case.pose_deg
    assert sum(isinstance(answer, ContactState) for answer in answers) >= 3


def test_exact_method_refuses_one_pose_and_answers_its_neighbours() -> None:
    undecided = (0.1790897872180624, 0.2289943449118028, 2.2930289846362895)
    cases = [Case(PAIR, THREE_POINT), Case(PAIR, undecided), Case(PAIR, THREE_POINT)]
    before, refused, after = ExactMethod().answers(cases)
    assert before == after == solve_pose(PAIR, *THREE_POINT)
    assert isinstance(refused, Refusal)
    assert "excluded" in refused.reason


def test_mesh_refuses_a_level_bolt_in_phase_with_the_reason() -> None:
    (answer,) = COARSE.answers([Case(PAIR, (0.0, 0.0, 0.0))])
    assert isinstance(answer, Refusal)
    assert "in phase" in answer.reason


def test_declared_errors_grow_with_the_thread() -> None:
    large = scaled(PAIR, 10.0)
    for method in (ExactMethod(), COARSE):
        assert method.declared_error(large) == pytest.approx(10.0 * method.declared_error(PAIR))
    assert COARSE.declared_error(PAIR) > 2.5e-4 > 1e-8 > ExactMethod().declared_error(PAIR)


def test_moved_is_the_turn_times_the_reach_and_the_changes_of_the_radii() -> None:
    case = Case(PAIR, THREE_POINT)
    roll, pitch, phase = THREE_POINT
    turned = replace(case, pose_deg=(roll, pitch, phase + 1e-3))
    assert moved(case, turned) == pytest.approx(1.745329e-5 * case.reach, rel=1e-6)
    assert moved(case, replace(case, pose_deg=(roll, pitch, phase - 720.0))) == 0.0
    wider = replace(case, pair=with_dimensions(PAIR, (2e-4, 0.0, 0.0, 0.0, 0.0, 0.0, 3e-5)))
    assert moved(case, wider) == pytest.approx(1e-4 + 3e-5)


def test_between_halves_poses_and_dimensions_to_the_last_digit() -> None:
    low, high = Case(PAIR, (1.0, 2.0, 3.0)), Case(PAIR, (1.0, 2.5, 4.0))
    assert between(low, high).pose_deg == (1.0, 2.25, 3.5)
    wider = replace(low, pair=with_dimensions(PAIR, (0.0, 0.0, 0.0, 0.0, 0.0, 4e-4, 0.0)))
    middle = between(low, wider)
    assert middle.pair.fit.nut_minor_diameter == pytest.approx(PAIR.fit.nut_minor_diameter + 2e-4)
    steps = 0
    while not (same_input(middle := between(low, high), low) or same_input(middle, high)):
        high, steps = middle, steps + 1
    assert 45 < steps < 60


def test_options_reach_the_method() -> None:
    strict = Case(PAIR, THREE_POINT, SolveOptions(quasi_stable_fraction=1.0))
    plain, asked = ExactMethod().answers([Case(PAIR, THREE_POINT), strict])
    assert isinstance(plain, ContactState)
    assert isinstance(asked, ContactState)
    assert plain.pivot_margin is not None
    assert asked.pivot_margin is not None
    assert plain.pivot_margin - asked.pivot_margin == pytest.approx(0.9 * PAIR.nominal_diameter / 2.0)
