from __future__ import annotations

from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.network.cell_maps import ON_EDGE, ON_SURFACE, UNDECIDED, A, B, C, cell_maps, orientation_cells
from tests.network.test_formation import contacts
from threadstate.errors import InvalidValueError
from threadstate.history.labels import ContactLabels
from threadstate.network.cells import Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.locate import ContactObservation, Location, Observation, Stretch, locate
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import Region

TIE = (Flag.TIE,)
CELLS = (
    orientation_cells(0, [10.0, 100.0, 200.0, 300.0], [B, B, C, B], flags=[(), TIE, TIE, ()]),
    orientation_cells(1, [0.0, 180.0], [A, UNDECIDED]),
    orientation_cells(2, [0.0], [A]),
    orientation_cells(3, [0.0, 90.0], [B, A]),
)
CELL_MAP = CellMap((0.0, 1.0), CELLS)


def test_cells_of_a_formation_that_touch_are_one_stretch_through_phase_0() -> None:
    found = locate(CELL_MAP, Observation(state_class=StateClass.STABLE_THREE_POINT, contact_count=3))
    assert found.stretches == (
        Stretch(0, 200.0, 300.0, C),
        Stretch(0, 300.0, 560.0, B),
        Stretch(3, 0.0, 90.0, B),
    )
    assert found.width_by_formation == {B: 350.0, C: 100.0}
    assert found.share == 450.0 / 1440.0
    assert found.undecided_share == 0.125
    assert found.orientations == (0, 3)
    on_surface = Observation(contact_count=3, contacts=(ContactObservation(nut_region=Region.SURFACE),))
    assert locate(CELL_MAP, on_surface).stretches == (Stretch(0, 300.0, 560.0, B), Stretch(3, 0.0, 90.0, B))


def test_flags_and_features() -> None:
    assert locate(CELL_MAP, Observation(flags=frozenset(TIE))).stretches == (
        Stretch(0, 100.0, 200.0, B),
        Stretch(0, 200.0, 300.0, C),
    )
    edge = ContactObservation(stage=1, features=FeaturePair.EDGE_EDGE)
    assert locate(CELL_MAP, Observation(contacts=(edge,))).stretches == (Stretch(0, 200.0, 300.0, C),)


def test_what_was_observed_twice_is_two_contacts() -> None:
    once = ContactObservation(bolt_region=Region.FLANK_POS)
    assert locate(CELL_MAP, Observation(contacts=(once,))).share == 0.875
    assert locate(CELL_MAP, Observation(contacts=(once, once))) == Location((), 0.0, 0.125)


def test_ordered_contacts_are_the_first_ones() -> None:
    second = ContactObservation(bolt_region=Region.FLANK_POS)
    assert locate(CELL_MAP, Observation(contacts=(second,), ordered=True)).share == 0.0
    both = (ContactObservation(), second)
    assert locate(CELL_MAP, Observation(contacts=both, ordered=True)).share == 0.875


def test_values_that_nothing_can_have_are_refused() -> None:
    with pytest.raises(InvalidValueError, match="bolt_region is 'surface'"):
        ContactObservation(bolt_region=Region.SURFACE)
    with pytest.raises(InvalidValueError, match="nut_region is 'base'"):
        ContactObservation(nut_region=Region.BASE)
    with pytest.raises(InvalidValueError, match="stage is 4"):
        ContactObservation(stage=4)
    with pytest.raises(InvalidValueError, match="contact_count is 0; valid: at least 1"):
        Observation(contact_count=0, contacts=(ContactObservation(),))


@given(cell_maps(), st.data())
def test_what_a_state_shows_leaves_its_own_pose(cell_map: CellMap, data: st.DataObject) -> None:
    cell = data.draw(st.sampled_from(cell_map.all_cells))
    formation = cell.formation
    shown = data.draw(st.permutations(formation.contacts))[: data.draw(st.integers(0, len(formation.contacts)))]
    observation = Observation(
        data.draw(st.sampled_from([None, formation.state_class])),
        data.draw(st.sampled_from([None, len(formation.contacts)])),
        data.draw(st.sampled_from([frozenset(), frozenset(cell.flags)])),
        tuple(ContactObservation(c.stage, None, c.nut_region, None) for c in shown),
    )
    phases = [
        phase
        for one in locate(cell_map, observation).stretches
        if one.orientation == cell.orientation
        for phase in (one.start_deg, one.end_deg)
    ]
    decided = formation.state_class is not None
    held = any(
        low <= cell.start_deg + lap and cell.end_deg + lap <= high
        for low, high in zip(phases[::2], phases[1::2], strict=True)
        for lap in (0.0, 360.0)
    )
    assert held == decided


observed = st.builds(
    ContactObservation,
    st.sampled_from([None, 1, 2]),
    st.sampled_from([None, Region.CREST, Region.FLANK_NEG]),
    st.sampled_from([None, Region.SURFACE, Region.ROOT]),
)


@given(st.lists(observed, max_size=3), st.lists(st.sampled_from([ON_SURFACE, ON_EDGE]) | contacts, max_size=4))
def test_any_contacts_fit_if_they_do_in_some_order(seen: list[ContactObservation], there: list[ContactLabels]) -> None:
    cell = Cell(0, 0, 0.0, 360.0, Formation(StateClass.STABLE_THREE_POINT, tuple(there)), (), None, False)
    in_order = [
        all(one.fits(contact) for one, contact in zip(seen, order, strict=False)) and len(seen) <= len(there)
        for order in permutations(there)
    ]
    assert Observation(contacts=tuple(seen)).fits(cell) == any(in_order)
    assert Observation(contacts=tuple(seen), ordered=True).fits(cell) == in_order[0]
