"""The study of forms: what counts as a fault, and that none is passed over on its way to the page."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from oracle.profile import Q_LARGE, bolt_profile, radius
from oracle.solids import axial_position, outward, outward_of_faces, slope
from oracle.state_turns import _first_appearance, earlier_appearance, spreads_from_contact, turns_of
from studies.forms.page import page
from studies.forms.study import FORMS, METHOD, Amount, Found, Task, _look_at, _look_at_turns, done, pair_of, tasks
from studies.methods import Case
from studies.stability.brute_force import Fault, wrong_embedment
from studies.stability.change import SolvedCase
from threadstate.state.model import ContactState
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow

NO_PLAY, BUTTRESS = "1/4-20 UNJC-3A/3B", "1/2-20 BUTT-2A/2B at minimum material"
ACME = "1/4-16 ACME-2G with sharp corners"
SPREADING = (0.912263938019664, 1.7779500748341412, -18.61067466744038)
"""First contact of thread on thread at a sharp corner, from which the overlap spreads along the corner."""


def solved(form: str, pose: tuple[float, float, float]) -> SolvedCase:
    case = Case(pair_of(form), pose)
    (state,) = METHOD.answers([case])
    assert isinstance(state, ContactState)
    return SolvedCase(case, state)


def test_every_pose_is_a_task_once() -> None:
    found = list(tasks(Amount(heights=60, turns=30, centres=6), FORMS[:2]))
    for number in (0, 1):
        beside = [task for task in found if task.form == number and not task.perturb]
        assert [task.first for task in beside] == [0, 25, 50]
        assert [task.turns for task in beside] == [25, 5, 0]
        assert len({pose for task in beside for pose in task.poses}) == 60
        centres = [pose for task in found if task.form == number and task.perturb for pose in task.poses]
        assert len(set(centres)) == 6


def test_forms_are_in_inches_and_sharp_ones_have_no_fillets() -> None:
    for form in FORMS:
        pair = pair_of(form)
        fillets = {value for name, value in vars(pair.form).items() if name.endswith("_fillet")}
        assert pair.unit is LengthUnit.INCH
        assert 0.03 < pair.thread_pitch < 0.07, form
        assert (fillets == {0.0}) == ("sharp" in form)


@pytest.mark.parametrize("form", ["M6x1-6g/6H LH", ACME])
def test_states_of_the_solver_have_no_fault(form: str) -> None:
    _, *centres = tasks(Amount(heights=8, turns=2, centres=1), (form,))
    beside = done(Task(0, ((1.0, -2.0, 7.0), SPREADING, (-1.5, 2.0, 40.0)), 0, turns=3), (form,))
    beside.add(done(centres[0], (form,)))
    assert (beside.heights, beside.turns, beside.refused) == (3, 3, 0)
    assert beside.contacts >= 6
    assert beside.onsets >= 1
    assert beside.perturbed.trials > 150
    assert (beside.faults, beside.perturbed.failures) == ([], [])


def test_a_height_too_low_and_a_contact_off_the_surface_are_faults() -> None:
    right = solved(FORMS[0], (1.0, -2.0, 7.0))
    x, y, z = right.state.poses[0].translation
    low = replace(right.state.poses[0], translation=(x, y, z - 1e-6))
    found = Found()
    _look_at(SolvedCase(right.case, replace(right.state, poses=(low, *right.state.poses[1:]))), found)
    assert any("too low by 1.00e-06 in" in fault for fault in found.faults)
    assert any("stage 1" in fault for fault in found.faults)


def test_a_turn_that_goes_too_far_is_a_fault() -> None:
    right = solved(FORMS[0], (1.0, -2.0, 7.0))
    (first, *_), turned = right.state.contacts, right.state.lambda_deg
    assert turned is not None
    found = Found()
    beyond = replace(right.state, lambda_deg=turned + 0.2, poses=right.state.poses[:2], contacts=right.state.contacts)
    _look_at_turns(SolvedCase(right.case, beyond), found)
    assert first.stage == 1
    assert any("passes a contact onset" in fault for fault in found.faults)


def test_an_overlap_that_spreads_along_a_sharp_corner_is_none_of_its_own() -> None:
    at = solved(ACME, SPREADING)
    turn = turns_of(at.case.pair, at.state)[1]
    seen = earlier_appearance(at.case.pair, turn, 45.0, 14)
    assert seen is not None
    assert spreads_from_contact(at.case.pair, turn, seen)
    elsewhere = replace(turn, known=turn.known[1:])
    assert not spreads_from_contact(at.case.pair, elsewhere, seen)


def test_an_overlap_that_comes_in_over_the_bolts_far_end_is_no_contact_onset() -> None:
    at = solved(BUTTRESS, (3.5600489388680394, -1.0947261265274566, 14.14572662970312))
    turn = turns_of(at.case.pair, at.state)[1]
    assert _first_appearance(at.case.pair, turn, 45.0, 14, at_ends=True) is not None
    assert earlier_appearance(at.case.pair, turn, 45.0, 14) is None


def test_a_crest_that_slides_up_its_root_does_not_hold_the_bolt() -> None:
    at = solved(NO_PLAY, (0.26888479372430485, -0.4693193243897307, 19.733075750985428))
    assert at.state.embedment == 0.0
    assert wrong_embedment(at) == ""
    assert "least lift 0 in" in wrong_embedment(SolvedCase(at.case, replace(at.state, embedment=1e-4)))


def test_a_film_of_overlap_too_narrow_for_samples_is_looked_for_beside_contacts() -> None:
    at = solved("MJ6x1-4h6h/4H5H", (-0.5017938913173374, -3.676798736794823, 19.951138270648798))
    assert at.state.embedment is not None
    assert at.state.embedment == pytest.approx(3.486e-7, rel=1e-3)
    assert wrong_embedment(at) == ""
    assert wrong_embedment(SolvedCase(at.case, replace(at.state, embedment=at.state.embedment + 3e-8))) != ""


def test_a_contact_beside_a_film_of_overlap_begins_at_the_end_of_its_turn_and_not_elsewhere() -> None:
    at = solved(NO_PLAY, (-0.24541377575880485, -2.7383427408802836, 0.09018835225388165))
    found = Found()
    _look_at_turns(at, found)
    assert (found.onsets, found.faults) == (2, [])
    assert at.state.lambda_deg is not None
    _look_at_turns(SolvedCase(at.case, replace(at.state, lambda_deg=at.state.lambda_deg - 1e-2)), found)
    assert any("no contact begins where turn 2 ends" in fault for fault in found.faults)


def test_at_a_sharp_corner_both_faces_have_a_normal() -> None:
    pair = pair_of(ACME)
    bolt = bolt_profile(pair)
    r = pair.fit.bolt_major_diameter / 2.0
    corner = np.array([r, 0.0, 0.25 * pair.thread_pitch + bolt[Q_LARGE]])
    assert axial_position(corner, bolt) == corner[2]
    crest, flank = outward_of_faces(corner, bolt)
    assert crest[0] == pytest.approx(1.0, abs=1e-2)
    assert flank[2] == pytest.approx(math.cos(math.radians(14.5)), abs=1e-2)
    beside = corner + np.array([0.0, 0.0, 1e-3])
    (alone,) = outward_of_faces(beside, bolt)
    np.testing.assert_array_equal(alone, outward(beside, bolt))


@pytest.mark.parametrize("form", [FORMS[0], FORMS[10], ACME])
def test_slopes_are_those_of_differences(form: str) -> None:
    pair = pair_of(form)
    bolt, step = bolt_profile(pair), 1e-7 * pair.thread_pitch
    for s in np.random.default_rng(5).uniform(-2.0, 2.0, 200) * pair.thread_pitch:
        assert slope(s, bolt) == pytest.approx((radius(s + step, bolt) - radius(s - step, bolt)) / (2 * step), abs=1e-4)


def test_what_was_found_is_on_the_page() -> None:
    found = [Found(heights=7), Found(heights=11, faults=["(1, 2, 3): too low"])]
    found[0].perturbed.fail(Fault.LAW, Case(pair_of(FORMS[0]), (1.0, 2.0, 3.0)), "not finite")
    text = page(FORMS[:2], found)
    assert "18 heights" in text
    assert f"- {FORMS[1]}, (1, 2, 3): too low" in text
    assert f"- {FORMS[0]}, roll 1.0, pitch 2.0, phase 3.0: a law is broken, not finite" in text
    assert "## Faults" not in page(FORMS[:1], [Found()])
