from __future__ import annotations

import sys
from typing import Any

import pytest

from threadstate.client import Client, to_pandas, to_polars
from threadstate.client.frame_columns import COLUMNS, columns_and_sources
from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.states import State
from threadstate.errors import InvalidValueError, MissingExtraError


def test_a_frame_of_states_has_every_number_to_the_last_bit(client: Client, made_up_id: int) -> None:
    states = list(client.states(library=made_up_id))
    in_pandas = client.states(library=made_up_id).to_pandas()
    in_polars = client.states(library=made_up_id).to_polars()
    assert list(in_pandas.columns) == in_polars.columns
    assert len(in_pandas) == in_polars.height == len(states) == 108
    assert in_polars["class"].to_list() == [one.state_class for one in states]
    assert in_pandas["flags"].tolist() == [" ".join(one.flags) for one in states]
    for name, cells in (
        ("lambda", [one.turns[0] for one in states]),
        ("drop", [one.drop for one in states]),
        ("margin_pivot_offset", [one.margins.pivot_offset for one in states]),
        ("pose_3_r32", [one.poses[2].rotation[2][1] if len(one.poses) > 2 else None for one in states]),
        ("contact_4_normal_z", [one.contacts[3].normal[2] if len(one.contacts) > 3 else None for one in states]),
        ("contact_1_stage", [one.contacts[0].stage for one in states]),
        ("contact_2_features", [one.contacts[1].features if len(one.contacts) > 1 else None for one in states]),
    ):
        assert in_polars[name].to_list() == cells, name
        assert [None if one != one else one for one in in_pandas[name].fillna(float("nan"))] == cells, name


def test_everything_with_columns_makes_frames(client: Client) -> None:
    tables: list[Any] = [
        client.orientations().orientations,
        client.windows().windows,
        client.intervals(0, -3).history.intervals,
        client.locate(contact=["1:crest"]).location.stretches,
        list(client.transitions(roll=0, pitch=-3)),
    ]
    for items in tables:
        kind = type(items[0])
        columns, _ = columns_and_sources(kind, items)
        in_pandas, in_polars = to_pandas(items), to_polars(items)
        assert list(in_pandas.columns) == in_polars.columns == [column.name for column in columns]
        assert len(set(in_polars.columns)) == len(columns)
        assert len(in_pandas) == in_polars.height == len(items)
        for column in columns:
            assert in_polars[column.name].to_list() == [column.cell(item) for item in items]


@pytest.mark.parametrize("kind", [State, *COLUMNS], ids=lambda kind: kind.__name__)
def test_nothing_is_a_frame_with_the_same_columns(kind: type[object]) -> None:
    names = [column.name for column in columns_and_sources(kind, [])[0]]
    assert to_polars([], kind).columns == list(to_pandas([], kind).columns) == names


def test_lists_know_what_they_hold_without_anything_in_them(client: Client) -> None:
    assert "reason" in client.undecided().to_pandas().columns
    assert client.jobs().to_polars().columns[:3] == ["id", "kind", "state"]
    assert columns_and_sources(JobDocument, [])[0]


def test_what_has_no_columns_is_refused() -> None:
    for items in ([], [1]):
        with pytest.raises(InvalidValueError, match="WindowDocument"):
            to_pandas(items)


@pytest.mark.parametrize(("module", "make"), [("pandas", to_pandas), ("polars", to_polars)])
def test_a_library_that_is_not_installed_is_named_with_its_extra(
    monkeypatch: pytest.MonkeyPatch, module: str, make: Any
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=rf"pip install '\.\[{module}\]'"):
        make([])
