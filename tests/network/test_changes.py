from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from tests.network.cell_maps import ON_SURFACE, SECOND, THIRD, UNDECIDED, A, B, C
from tests.network.test_formation import formations
from threadstate.network.changes import ChangeKind, ContactDifference, difference
from threadstate.network.formation import Formation
from threadstate.state.model import StateClass
from threadstate.thread.regions import Region


def test_a_contact_gained_and_a_class_changed() -> None:
    found = difference(A, B)
    assert found.contacts == (ContactDifference(3, 0, None, THIRD),)
    assert found.kinds == {ChangeKind.CLASS, ChangeKind.GAINED}
    assert found.text == "unstable two-point to stable three-point; contact 3.1 gained: base on crest (base-edge)"
    assert difference(B, A).kinds == {ChangeKind.CLASS, ChangeKind.LOST}
    assert (
        difference(B, A).text == "stable three-point to unstable two-point; contact 3.1 lost: base on crest (base-edge)"
    )


def test_a_contact_with_other_labels() -> None:
    found = difference(B, C)
    assert [(one.stage, one.place) for one in found.contacts] == [(1, 0)]
    assert found.kinds == {ChangeKind.BOLT_REGION, ChangeKind.NUT_REGION, ChangeKind.FEATURES}
    assert found.text == "contact 1.1 bolt negative flank to crest, nut surface to root, edge-surface to edge-edge"


def test_contacts_are_compared_within_their_stage() -> None:
    tie = replace(ON_SURFACE, bolt_region=Region.CREST)
    found = difference(B, Formation(B.state_class, (ON_SURFACE, tie, SECOND, THIRD)))
    assert found.contacts == (ContactDifference(1, 1, None, tie),)


def test_contacts_of_an_undecided_formation_are_not_known() -> None:
    assert difference(B, UNDECIDED).contacts == ()
    assert difference(B, UNDECIDED).kinds == {ChangeKind.CLASS}
    assert difference(UNDECIDED, B).text == "undecided to stable three-point"


@given(formations, formations)
def test_a_difference_backwards_is_the_same_with_sides_exchanged(one: Formation, other: Formation) -> None:
    there, back = difference(one, other), difference(other, one)
    assert [(c.stage, c.place, c.after, c.before) for c in there.contacts] == [
        (c.stage, c.place, c.before, c.after) for c in back.contacts
    ]
    exchanged = {ChangeKind.GAINED: ChangeKind.LOST, ChangeKind.LOST: ChangeKind.GAINED}
    assert {exchanged.get(kind, kind) for kind in there.kinds} == back.kinds


@given(st.sampled_from(StateClass), st.permutations([ON_SURFACE, SECOND, THIRD]))
def test_a_formation_does_not_differ_from_itself(state_class: StateClass, contacts: list[object]) -> None:
    formation = Formation(state_class, (ON_SURFACE, SECOND, THIRD)[: len(contacts)])
    assert difference(formation, formation).kinds == frozenset()
    assert difference(formation, formation).text == ""
