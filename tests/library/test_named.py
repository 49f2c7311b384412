"""Which library a name means, and the one that is pinned."""

from __future__ import annotations

import re

import pytest
from sqlalchemy import Engine, select

from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from threadstate.errors import NotFoundError
from threadstate.library.grid import Grid
from threadstate.library.named import LATEST, LATEST_MESH, named_library, slug
from threadstate.library.tables import library
from threadstate.library.write import pin_library
from threadstate.mesh.options import MeshOptions
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc

CLASSIC, NEWER = quarter_twenty_unc(), quarter_twenty_unc(RootForm.NEWER)


@pytest.fixture
def numbers(database: str) -> tuple[int, int, int, int]:
    """Four libraries in the order of their publication: two of the classic root, one of the newer, one by meshes."""
    stored = (
        store_library(database, CLASSIC, Grid(0.0, 1.0, 180.0), made_up_states),
        store_library(database, CLASSIC, Grid(0.0, 1.0, 90.0), made_up_states),
        store_library(database, NEWER, Grid(0.0, 1.0, 180.0), made_up_states),
        store_library(database, CLASSIC, Grid(0.0, 1.0, 180.0), made_up_states, MeshOptions()),
    )
    return stored[0].id, stored[1].id, stored[2].id, stored[3].id


def _found(engine: Engine, *names: str) -> list[int]:
    with engine.connect() as connection:
        return [named_library(connection, name).id for name in names]


def test_a_name_is_a_number_a_designation_a_slug_or_the_latest(
    reader: Engine, numbers: tuple[int, int, int, int]
) -> None:
    first, second, newer, mesh = numbers
    names = (LATEST, LATEST_MESH, str(first), CLASSIC.designation, slug(CLASSIC.designation), NEWER.designation)
    assert _found(reader, *names) == [newer, mesh, first, second, second, newer]
    assert _found(reader, "1/4-20 unc-2a/2b", "1/4-20  UNC NEWER ROOT", "1/4-20 UNC-2B at maximum") == [
        second,
        newer,
        second,
    ]


@pytest.mark.parametrize("name", ["99", "9" * 30, "m6x1", ""])
def test_an_unknown_name_is_told_those_that_there_are(
    reader: Engine, numbers: tuple[int, int, int, int], name: str
) -> None:
    first, second, newer, mesh = numbers
    listed = f"{mesh} (1-4-20-unc, by meshes), {newer} (1-4-20-unc-newer-root), {second} (1-4-20-unc), {first}"
    with pytest.raises(NotFoundError, match=re.escape(f"published are: {listed} (1-4-20-unc)")):
        _found(reader, name)


def test_where_nothing_is_published_a_name_says_so(reader: Engine) -> None:
    with pytest.raises(NotFoundError, match="published are: none yet"):
        _found(reader, "m6x1")


def test_the_pinned_library_is_the_latest_until_it_is_unpinned(
    database: str, writer: Engine, reader: Engine, numbers: tuple[int, int, int, int]
) -> None:
    first, second, newer, _ = numbers
    names = (LATEST, CLASSIC.designation, NEWER.designation)
    pin_library(writer, first)
    assert _found(reader, *names) == [first, first, newer]
    later = store_library(database, NEWER, Grid(0.0, 1.0, 90.0), made_up_states)
    assert _found(reader, *names) == [first, first, later.id]
    pin_library(writer, newer)
    assert _found(reader, *names) == [newer, second, newer]
    with reader.connect() as connection:
        pinned = connection.scalars(select(library.c.id).where(library.c.pinned_at.is_not(None))).all()
    assert pinned == [newer]
    pin_library(writer, None)
    assert _found(reader, *names) == [later.id, second, later.id]


def test_slug_is_lower_case_with_single_hyphens() -> None:
    assert slug("1/4-20 UNC") == "1-4-20-unc"
    assert slug("  M6 x 1 (6g) ") == "m6-x-1-6g"
