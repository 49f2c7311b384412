from __future__ import annotations

from dataclasses import replace

import pytest

from tests.mesh.pairs import UNC
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.agreement import COARSENING, disagreement, other_tessellation
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import LARGEST_CHORD, Preset, Tessellation
from threadstate.mesh.solve import solve_poses_by_mesh
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag
from threadstate.state.solve import solve_pose

pytestmark = pytest.mark.slow

NEAR = 1e-3
THREE = solve_pose(UNC, 1.0, -2.0, 10.0)
FLUSH = solve_pose(UNC, 4.0, 0.0, 185.0)


def with_third(**changes: object) -> ContactState:
    """The state with its third contact changed."""
    third = replace(THREE.contacts[2], **changes)  # type: ignore[arg-type]
    return replace(THREE, contacts=(*THREE.contacts[:2], third))


def moved(contact: Contact, by: float) -> tuple[float, float, float]:
    x, y, z = contact.point
    return x + by, y, z


def test_a_state_agrees_with_itself_and_with_what_is_near() -> None:
    assert disagreement(THREE, THREE, NEAR) is None
    near = with_third(point=moved(THREE.contacts[2], 0.9 * NEAR))
    assert disagreement(THREE, near, NEAR) is disagreement(near, THREE, NEAR) is None
    assert disagreement(replace(THREE, flags=(Flag.TIE,)), THREE, NEAR) is None


@pytest.mark.parametrize(
    "other",
    [
        with_third(point=moved(THREE.contacts[2], 1.1 * NEAR)),
        with_third(features=FeaturePair.THREAD_EDGE),
        with_third(stage=2),
        replace(THREE, contacts=THREE.contacts[:2]),
    ],
)
def test_another_contact_is_named(other: ContactState) -> None:
    for one, two in ((THREE, other), (other, THREE)):
        assert "two tessellations disagree about the contact of stage" in str(disagreement(one, two, NEAR))


def test_lying_flush_has_to_agree_and_the_extreme_points_of_a_patch_need_not() -> None:
    assert Flag.FLUSH in FLUSH.flags
    fewer = replace(FLUSH, contacts=FLUSH.contacts[:-1])
    assert fewer.contacts[-1].features is FeaturePair.FLUSH
    assert disagreement(FLUSH, fewer, NEAR) is None
    assert disagreement(FLUSH, replace(FLUSH, flags=(Flag.NO_SECOND,)), NEAR) is not None


@pytest.mark.parametrize("chord", [2e-6, 2e-5, 4e-4, 5e-3, 1e-2, LARGEST_CHORD])
def test_the_other_tessellation_is_four_times_apart_and_in_range(chord: float) -> None:
    options = MeshOptions(Tessellation(chord, 0.5))
    other = other_tessellation(options)
    ratio = other.tessellation.chord_height / chord
    assert ratio == pytest.approx(COARSENING) or ratio == pytest.approx(1.0 / COARSENING)
    assert replace(other, tessellation=options.tessellation) == options


def test_a_state_that_another_tessellation_does_not_have_is_refused() -> None:
    """The second contact lies 1e-2 in from the first, the mesh's facets touch in another place before."""
    pose = (2.6, -3.95, 20.84)
    medium = MeshOptions(Preset.MEDIUM.tessellation, checked=False)
    exact, (wrong,) = solve_pose(UNC, *pose), solve_poses_by_mesh(UNC, [pose], medium)
    assert wrong.contacts[1].features is not exact.contacts[1].features
    with pytest.raises(MeshUndecidedError, match="two tessellations disagree about the contact of stage 2"):
        solve_poses_by_mesh(UNC, [pose], replace(medium, checked=True))
