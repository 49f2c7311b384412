"""docs/glossary.md has every term of the interface, once."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path

import pytest

from service.app import create_app
from threadstate.chances.document import RecordDocument, VisitDocument
from threadstate.chances.model import Leaving, LegName
from threadstate.chances.network_document import (
    ChanceDocument,
    ChancesDocument,
    FormationMoveDocument,
    FormationNodeDocument,
    OutcomeShareDocument,
    RemainingDocument,
    TurningDocument,
    WatchDocument,
)
from threadstate.device.assembly_document import (
    AssemblyDocument,
    AssemblyEnergyDocument,
    AssemblyEventDocument,
    AssemblyMarginsDocument,
    AssemblyPathDocument,
    AssemblyProgressDocument,
    AssemblyTravelDocument,
)
from threadstate.device.assembly_model import AssemblyOutcome, Held, PathEventKind
from threadstate.device.document import (
    DeviationDocument,
    FallDocument,
    SettledContactDocument,
    SettledDocument,
    SettledMarginsDocument,
)
from threadstate.device.model import Outcome, SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.network.changes import ChangeKind
from threadstate.network.moves import Move
from threadstate.state.document import StateDocument
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.statics.verdict import Verdict
from threadstate.success.document import (
    CellDocument,
    CriticalFrictionDocument,
    OrientationDocument,
    PhaseBoundaryDocument,
)
from threadstate.thread.regions import Region

OTHER_STANDARDS = ("Problem", "ProblemItem", "Health", "Readiness", "NodeLinkNetwork")
"""Schemas whose fields are others' words: RFC 9457's, those of the probes and networkx's; docs/api.md names them."""


def terms(page: str) -> list[list[str]]:
    """The terms of each row, bold ones with their asterisks."""
    rows = re.findall(r"^\| ([`*].*?) \| .* \| .* \| \[.*\) \|$", page, re.MULTILINE)
    return [re.findall(r"`[^`]+`|\*\*[^*]+\*\*", row) for row in rows]


def bare(term: str) -> str:
    """A term without its marks."""
    return term.strip("`*")


@pytest.fixture(scope="module")
def rows(repository_root: Path) -> list[list[str]]:
    """The terms of each row of the page."""
    return terms((repository_root / "docs" / "glossary.md").read_text())


@pytest.fixture(scope="module")
def known(rows: list[list[str]]) -> set[str]:
    """All terms."""
    return {bare(term) for row in rows for term in row}


def columns(source: str) -> Iterator[str]:
    """The headings of the tables that a module of the command line prints, without units."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "table":
            for heading in node.args:
                parts = heading.values if isinstance(heading, ast.JoinedStr) else [heading]
                first = parts[0]
                if isinstance(first, ast.Constant) and first.value:
                    yield re.sub(r" *\(.*", "", str(first.value)).strip()


def test_terms_are_there_once_and_in_order(rows: list[list[str]]) -> None:
    assert [term for term, times in Counter(term for row in rows for term in row).items() if times > 1] == []
    heads = [re.sub(r"[^a-z0-9]", " ", bare(row[0]).lower()) for row in rows]
    assert heads == sorted(heads)


def test_every_row_is_read(repository_root: Path, rows: list[list[str]]) -> None:
    lines = [line for line in (repository_root / "docs" / "glossary.md").read_text().splitlines() if line[:1] == "|"]
    assert len(rows) == len(lines) - 2


def test_every_field_of_an_answer_is_a_term(known: set[str]) -> None:
    schemas = create_app().openapi()["components"]["schemas"]
    fields = {
        field
        for name, schema in schemas.items()
        if name not in OTHER_STANDARDS
        for field in schema.get("properties", ())
    }
    assert set(StateDocument.__annotations__) <= fields
    assert sorted(fields - known) == []


@pytest.mark.parametrize(
    "names",
    [
        *(StateClass, Flag, FeaturePair, Region, Move, ChangeKind, Verdict, Outcome, SettledFlag),
        *(AssemblyOutcome, PathEventKind, Held, Strategy, Leaving, LegName),
    ],
)
def test_every_name_of_an_answer_is_a_term(known: set[str], names: type[StrEnum]) -> None:
    assert sorted({name.value for name in names} - known) == []


def test_every_field_of_a_settled_state_is_a_term(known: set[str]) -> None:
    documents = (SettledDocument, DeviationDocument, SettledContactDocument, FallDocument, SettledMarginsDocument)
    assert sorted({name for document in documents for name in document.__annotations__} - known) == []


def test_every_field_of_a_path_is_a_term(known: set[str]) -> None:
    documents = (
        *(AssemblyDocument, AssemblyEventDocument, AssemblyPathDocument, AssemblyEnergyDocument),
        *(AssemblyMarginsDocument, AssemblyTravelDocument, AssemblyProgressDocument),
    )
    assert sorted({name for document in documents for name in document.__annotations__} - known) == []


def test_every_field_of_a_success_map_is_a_term(known: set[str]) -> None:
    documents = (OrientationDocument, CellDocument, PhaseBoundaryDocument, CriticalFrictionDocument)
    assert sorted({name for document in documents for name in document.__annotations__} - known) == []


def test_every_field_of_sampled_paths_is_a_term(known: set[str]) -> None:
    documents = (
        *(RecordDocument, VisitDocument, ChancesDocument, ChanceDocument, OutcomeShareDocument, TurningDocument),
        *(FormationNodeDocument, FormationMoveDocument, RemainingDocument, WatchDocument),
    )
    assert sorted({name for document in documents for name in document.__annotations__} - known) == []


def test_every_column_of_a_table_is_a_term(repository_root: Path, known: set[str]) -> None:
    headings = {heading for path in (repository_root / "worker").rglob("*.py") for heading in columns(path.read_text())}
    assert {"snap from", "pivot offset", "steepest in"} <= headings
    assert sorted(headings - known) == []


def test_every_word_of_the_readme_is_a_term(repository_root: Path, known: set[str]) -> None:
    words = re.findall(r"^\| ([a-z][a-z, ]*) \| ", (repository_root / "README.md").read_text(), re.MULTILINE)
    defined = {word for row in words for word in row.split(", ")} - {"word"}
    assert {"roll", "phase", "snap"} <= defined
    assert sorted(defined - known) == []
