"""States by meshes against those of the exact method."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest

from tests.mesh.pairs import M6, UNC
from threadstate.errors import InvalidValueError, MeshUndecidedError
from threadstate.mesh.options import Descent, FinalStep, MeshOptions, Tangent
from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Preset
from threadstate.mesh.solid import deviation
from threadstate.mesh.solve import mesh_procedure, solve_poses_by_mesh
from threadstate.state.model import ContactState, FeaturePair, Flag, StateClass
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.pair import Pair, Part

pytestmark = pytest.mark.slow

Pose = tuple[float, float, float]

COARSE, PAPER, MEDIUM = (
    MeshOptions(preset.tessellation, checked=False) for preset in (Preset.COARSE, Preset.PAPER, Preset.MEDIUM)
)
MICROINCH = 1e-6

COMPARED = 12
ANGLE_DEG = 0.06
"""Turns by medium meshes: of 150 random poses the largest error of a second one was 0.041 deg, of a third 0.036."""


def segment_inch(options: MeshOptions) -> float:
    """The longest segment of the bolt's outline: where along an edge a mesh touches is known no better."""
    solid = part_solid(UNC, Part.BOLT, options.tessellation)
    edge = solid.vertices[solid.edge]
    return max(math.dist(a, b) for a, b in pairwise(edge))


def is_clear(state: ContactState, segment: float) -> bool:
    """Whether the meshes can tell its contacts and their features apart."""
    points = [contact.point for contact in state.contacts]
    margins = [margin for contact in state.contacts for margin in (contact.bolt_margin, contact.nut_margin)]
    return (
        all(math.dist(a, b) > 2.0 * segment for a, b in combinations(points, 2))
        and min(margins) > 0.1 * segment
        and not {Flag.NO_SECOND, Flag.NO_THIRD, Flag.BALANCED, Flag.GRAZING} & set(state.flags)
    )


def clear_poses() -> list[Pose]:
    """The first random poses whose states are clear; turns that end without contact take long and come apart."""
    rng = np.random.default_rng(42)
    found: list[Pose] = []
    while len(found) < COMPARED:
        roll, pitch, phase = rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0]).round(2).tolist()
        if is_clear(solve_pose(UNC, roll, pitch, phase), segment_inch(MEDIUM)):
            found.append((roll, pitch, phase))
    return found


def test_states_are_those_of_the_exact_method() -> None:
    poses = clear_poses()
    exact = [solve_pose(UNC, *pose) for pose in poses]
    by_mesh = solve_poses_by_mesh(UNC, poses, MEDIUM)
    deviations = sum(
        deviation(part_solid(UNC, part, MEDIUM.tessellation), profile).edge
        for part, profile in ((Part.BOLT, UNC.bolt), (Part.NUT, UNC.nut))
    )
    segment = segment_inch(MEDIUM)
    assert {len(state.poses) for state in exact} == {2, 3}
    for one, other in zip(exact, by_mesh, strict=True):
        assert other.poses[0].translation[2] == pytest.approx(one.poses[0].translation[2], abs=deviations + MICROINCH)
        assert other.flags == one.flags
        assert other.state_class == one.state_class
        assert other.lambda_deg == pytest.approx(one.lambda_deg, abs=ANGLE_DEG)
        assert (other.mu_deg is None) == (one.mu_deg is None)
        if one.mu_deg is not None:
            assert other.mu_deg == pytest.approx(one.mu_deg, abs=ANGLE_DEG)
        touching = [contact for contact in one.contacts if contact.features is not FeaturePair.FLUSH]
        for mine, found in zip(touching, other.contacts, strict=False):
            assert (found.stage, found.features) == (mine.stage, mine.features)
            assert found.point == pytest.approx(mine.point, abs=segment)
            if min(mine.bolt_margin, mine.nut_margin) > segment:
                assert (found.bolt_region, found.nut_region) == (mine.bolt_region, mine.nut_region)


def test_finer_meshes_come_nearer() -> None:
    pose = (1.0, -2.0, 10.0)
    exact = solve_pose(UNC, *pose)
    errors = []
    for options in (COARSE, PAPER, MEDIUM):
        (state,) = solve_poses_by_mesh(UNC, [pose], options)
        errors.append(abs(state.poses[0].translation[2] - exact.poses[0].translation[2]))
        assert state.state_class is exact.state_class
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-5


def test_a_metric_pair_is_solved_in_its_own_unit() -> None:
    pose = (0.0, 3.0, 250.0)
    exact = solve_pose(M6, *pose)
    (state,) = solve_poses_by_mesh(M6, [pose], MEDIUM)
    assert state.poses[0].translation[2] == pytest.approx(exact.poses[0].translation[2], abs=2e-4)
    assert state.state_class is exact.state_class
    assert [contact.features for contact in state.contacts] == [contact.features for contact in exact.contacts]


def first_height(options: MeshOptions, pose: Pose, pair: Pair = UNC) -> float:
    found, _ = mesh_procedure(pair, options).first_pose(pose)
    return float(found[2, 3])


def test_the_decade_descent_tunnels_where_the_safe_one_does_not() -> None:
    pose = (0.0, -4.0, 350.0)
    exact_inch = solve_pose(UNC, *pose).poses[0].translation[2]
    decades = MeshOptions(MEDIUM.tessellation, Descent.DECADES)
    assert first_height(MEDIUM, pose) == pytest.approx(exact_inch, abs=5e-6)
    assert first_height(decades, pose) < exact_inch - 0.01
    elsewhere = (0.0, 3.0, 250.0)
    assert first_height(decades, elsewhere) == pytest.approx(first_height(MEDIUM, elsewhere), abs=2e-6)


def test_a_final_step_of_ten_microinches_ends_lower_by_as_much() -> None:
    for pose in ((4.0, 0.0, 185.0), (-4.0, 0.0, 131.0), (1.0, -2.0, 10.0)):
        fine = MeshOptions(MEDIUM.tessellation, final_step=FinalStep.ONE_MICROINCH.thread_pitches / 10.0)
        finest = first_height(fine, pose)
        for step, inch in ((FinalStep.ONE_MICROINCH, 1e-6), (FinalStep.TEN_MICROINCH, 1e-5)):
            height = first_height(MeshOptions(MEDIUM.tessellation, final_step=step.thread_pitches), pose)
            assert 0.0 <= finest - height + 1e-7 <= inch + 1e-7


def test_with_the_azimuthal_tangent_the_edge_rolls_into_the_nut() -> None:
    """What lies flush by the edge's tangent turns on beyond its tilt: method, section 4."""
    pose = (4.0, 0.0, 185.0)
    up_to = SolveOptions(turn_limit_deg=6.0)
    (flush,) = solve_poses_by_mesh(UNC, [pose], PAPER, up_to)
    azimuthal = replace(PAPER, tangent=Tangent.AZIMUTHAL)
    (rolling,) = solve_poses_by_mesh(UNC, [pose], azimuthal, up_to)
    assert flush.flags == (Flag.FLUSH,)
    assert flush.lambda_deg == pytest.approx(4.0, abs=1e-3)
    assert Flag.FLUSH not in rolling.flags
    assert rolling.lambda_deg is None or rolling.lambda_deg > 4.0


def test_a_hole_in_an_overlap_is_no_third_contact() -> None:
    """At a third turn of 15 deg, deep in the nut, the two threads part along a slit within their overlap."""
    (state,) = solve_poses_by_mesh(UNC, [(0.0, -4.0, 0.0)], MEDIUM, SolveOptions(turn_limit_deg=16.5))
    assert Flag.NO_THIRD in state.flags
    assert state.state_class is StateClass.UNSTABLE_TWO_POINT


@pytest.mark.parametrize("pose", [(1.885, -1.587, 60.351), (0.558, -2.836, 69.287), (-2.412, -1.095, 64.586)])
def test_a_third_contact_that_soon_grows_together_with_the_second_is_seen(pose: Pose) -> None:
    """The two are apart for some 0.05 deg of turn, about a step of the march."""
    exact = solve_pose(UNC, *pose)
    (state,) = solve_poses_by_mesh(UNC, [pose], MEDIUM)
    assert state.mu_deg == pytest.approx(exact.mu_deg, abs=ANGLE_DEG)
    assert state.state_class is exact.state_class
    assert [contact.features for contact in state.contacts] == [contact.features for contact in exact.contacts]


def test_a_level_bolt_out_of_phase_lies_flush() -> None:
    (state,) = solve_poses_by_mesh(UNC, [(0.0, 0.0, 50.0)], MEDIUM)
    exact = solve_pose(UNC, 0.0, 0.0, 50.0)
    assert (state.flags, state.state_class, state.poses) == (exact.flags, exact.state_class, exact.poses)
    assert len(state.contacts) == len(exact.contacts)
    for one, other in zip(exact.contacts, state.contacts, strict=True):
        assert other.features is FeaturePair.FLUSH
        assert other.point == pytest.approx(one.point, abs=segment_inch(MEDIUM))


@pytest.mark.parametrize(
    ("pose", "options", "reason"),
    [
        ((0.0, 0.0, 0.0), PAPER, "strip of its thread"),
        ((-2.283, 0.51, 340.13), MEDIUM, "within a ring of triangles about an earlier one"),
    ],
)
def test_what_meshes_cannot_answer_is_an_error_with_its_reason(pose: Pose, options: MeshOptions, reason: str) -> None:
    with pytest.raises(MeshUndecidedError, match=reason) as error:
        solve_poses_by_mesh(UNC, [pose], options)
    assert error.value.pose_deg == pose
    assert reason in error.value.reason


def test_the_same_pose_gives_the_same_bits_whatever_the_others_are() -> None:
    poses = [(1.0, -2.0, 10.0), (4.0, 0.0, 185.0), (-4.0, 0.0, 131.0)]
    alone = [solve_poses_by_mesh(UNC, [pose], PAPER)[0] for pose in poses]
    assert solve_poses_by_mesh(UNC, poses[::-1], PAPER)[::-1] == alone
    assert solve_poses_by_mesh(UNC, [], PAPER) == []


@pytest.mark.parametrize("step", [0.0, -1.0, 0.1, math.nan])
def test_a_final_step_out_of_range_is_named(step: float) -> None:
    with pytest.raises(InvalidValueError, match="final_step"):
        MeshOptions(final_step=step)


def test_final_steps_are_the_papers_on_its_thread() -> None:
    assert [step.thread_pitches * UNC.thread_pitch for step in FinalStep] == pytest.approx([1e-6, 1e-5])
