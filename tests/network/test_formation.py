from __future__ import annotations

import hashlib

from hypothesis import given
from hypothesis import strategies as st

from tests.network.cell_maps import FORMATIONS, UNDECIDED, B
from threadstate.history.labels import ContactLabels, Labels
from threadstate.network.formation import Formation, formation_of
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS

contacts = st.builds(
    ContactLabels,
    st.sampled_from([1, 2, 3]),
    st.sampled_from(BOLT_REGIONS),
    st.sampled_from(NUT_REGIONS),
    st.sampled_from(FeaturePair),
)
formations = st.builds(Formation, st.sampled_from([None, *StateClass]), st.lists(contacts, max_size=4).map(tuple))


@given(formations, formations)
def test_equal_formations_and_no_others_share_a_key(one: Formation, other: Formation) -> None:
    assert (one == other) == (one.key == other.key) == (one.canonical == other.canonical)
    assert one.key == Formation(one.state_class, one.contacts).key


def test_a_key_is_the_digest_of_names_alone() -> None:
    assert B.canonical == (
        "stable_three_point|1:flank_neg:surface:edge-surface|2:flank_pos:flank_neg:edge-edge|3:base:crest:base-edge"
    )
    assert B.key == hashlib.sha256(B.canonical.encode()).hexdigest()[:10] == "7e2d7eb326"


def test_text_is_in_the_terms_of_the_field() -> None:
    assert B.text == (
        "stable three-point: 1 negative flank on surface (edge-surface); "
        "2 positive flank on negative flank (edge-edge); 3 base on crest (base-edge)"
    )
    assert UNDECIDED.text == "undecided"
    assert len({formation.text for formation in FORMATIONS}) == len(FORMATIONS)


@given(formations, st.sampled_from([(), (Flag.TIE,)]))
def test_flags_are_no_part_of_a_formation(formation: Formation, flags: tuple[Flag, ...]) -> None:
    assert formation_of(Labels(formation.state_class, flags, formation.contacts)) == formation
