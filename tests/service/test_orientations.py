from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from fastapi.testclient import TestClient

from service.orientations import OrientationsAnswer
from tests.service.conftest import StoredLibrary
from threadstate.state.model import ContactState, StateClass
from threadstate.units import MILLIMETRES_PER_INCH

pytestmark = pytest.mark.sqlite_alone

ORIENTATIONS = "/v1/libraries/latest/orientations"


def _margins(state: ContactState) -> list[float]:
    margins = (state.drop_margin, state.embedment_margin, state.pivot_margin)
    return [abs(margin) for margin in margins if margin is not None]


def _extreme(choose: Callable[[list[float]], float], values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return choose(known) if known else None


def test_each_orientation_sums_up_its_states(client: TestClient, made_up: StoredLibrary) -> None:
    answer = OrientationsAnswer.model_validate(client.get(ORIENTATIONS).json())
    shown = [(one.roll, one.pitch) for one in answer.orientations]
    assert shown == [(roll, pitch) for roll in made_up.grid.tilts_deg for pitch in made_up.grid.tilts_deg]
    for one in answer.orientations:
        states = [state for state in made_up.states if (state.roll_deg, state.pitch_deg) == (one.roll, one.pitch)]
        assert one.counts == {name: sum(state.state_class is name for state in states) for name in StateClass}
        assert one.drop_most == _extreme(max, (state.drop for state in states))
        assert one.embedment_most == _extreme(max, (state.embedment for state in states))
        assert one.pivot_offset_least == _extreme(min, (state.pivot_offset for state in states))
        first = made_up.grid.first_ordinal(shown.index((one.roll, one.pitch)))
        statics = [made_up.statics[ordinal] for ordinal in range(first, first + made_up.grid.phase_count)]
        known = [found for found in statics if found is not None]
        assert one.mu_hold_least == _extreme(min, (found.mu_hold for found in known))
        assert one.mu_wedge_least == _extreme(min, (found.mu_wedge for found in known))
        assert one.support_margin_most == _extreme(max, (found.support_margin for found in known))
        assert one.margin_least == _extreme(min, (margin for state in states for margin in _margins(state)))


def test_lengths_are_in_the_unit_asked_for(client: TestClient) -> None:
    stored = client.get(ORIENTATIONS).json()
    metric = client.get(ORIENTATIONS, params={"unit": "mm"}).json()
    assert (stored["unit"], metric["unit"]) == ("in", "mm")
    for one, other in zip(stored["orientations"], metric["orientations"], strict=True):
        assert other["counts"] == one["counts"]
        assert other["drop_most"] == pytest.approx(one["drop_most"] * MILLIMETRES_PER_INCH, rel=1e-15)
