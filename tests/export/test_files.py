"""Exported files: every number of the library, the same in each format, in memory that does not grow."""

from __future__ import annotations

import csv
import io
import json
import struct
import sys
from typing import Any

import pytest
from pyarrow import parquet
from sqlalchemy import Engine, event

from tests.export.conftest import record
from threadstate.errors import MissingExtraError, NotFoundError
from threadstate.export import parquet as parquet_module
from threadstate.export import read
from threadstate.export.column import Cell, Kind
from threadstate.export.file import file_parts, file_sha256
from threadstate.export.names import FileFormat, TableName
from threadstate.export.read import exported_table
from threadstate.library.read import LibraryRecord, states_between
from threadstate.library.tables import library as library_table
from threadstate.state.document import state_document
from threadstate.units import LengthUnit

INCH = LengthUnit.INCH
LIBRARIES = (1, 2)


def content(
    engine: Engine, library: LibraryRecord, table: TableName, file_format: FileFormat, unit: LengthUnit = INCH
) -> bytes:
    return b"".join(file_parts(engine, library, table, file_format, unit))


def rows_of(file: bytes, file_format: FileFormat, kinds: dict[str, Kind]) -> list[dict[str, Any]]:
    """The rows of a file, each cell as what its column's kind says."""
    match file_format:
        case FileFormat.PARQUET:
            found: list[dict[str, Any]] = parquet.read_table(io.BytesIO(file)).to_pylist()
            return found
        case FileFormat.NDJSON:
            return [json.loads(line) for line in file.decode().splitlines()]
        case FileFormat.CSV:
            return [
                {name: _read(cell, kinds[name]) for name, cell in row.items()}
                for row in csv.DictReader(io.StringIO(file.decode(), newline=""))
            ]


def _read(cell: str, kind: Kind) -> Cell:
    match kind:
        case Kind.TEXT:
            return cell
        case _ if cell == "":
            return None
        case Kind.INTEGER:
            return int(cell)
        case Kind.NUMBER:
            return float(cell)
        case Kind.TRUTH:
            return {"true": True, "false": False}[cell]


def bits(cell: Cell, kind: Kind) -> object:
    """A cell as what two formats have to agree in: the bits of a number; no text is as good as an empty one."""
    if kind is Kind.TEXT:
        return cell or ""
    return struct.pack("<d", cell) if isinstance(cell, float) else cell


@pytest.mark.parametrize("library_id", LIBRARIES)
@pytest.mark.parametrize("table", TableName)
def test_every_format_holds_the_same_to_the_last_bit(engine: Engine, library_id: int, table: TableName) -> None:
    library = record(engine, library_id)
    found = exported_table(engine, library, table, 1.0)
    kinds = {column.name: column.kind for column in found.columns}
    expected = [row for batch in found.batches for row in batch]
    assert len(kinds) == len(found.columns)
    for file_format in FileFormat:
        rows = rows_of(content(engine, library, table, file_format), file_format, kinds)
        assert [[bits(cell, kinds[name]) for name, cell in row.items()] for row in rows] == [
            [bits(cell, kind) for cell, kind in zip(row, kinds.values(), strict=True)] for row in expected
        ]


@pytest.mark.parametrize("unit", LengthUnit)
def test_states_are_all_there_with_all_that_their_documents_have(engine: Engine, unit: LengthUnit) -> None:
    library = record(engine, 1)
    factor = 1.0 if unit is INCH else 25.4
    with engine.connect() as connection:
        states = states_between(connection, 1, 0, library.grid.pose_count)
    rows = rows_of(content(engine, library, TableName.STATES, FileFormat.NDJSON, unit), FileFormat.NDJSON, {})
    assert len(rows) == len(states) == 108
    for row, state in zip(rows, states, strict=True):
        document = state_document(state, factor)
        assert row["class"] == document["class"]
        assert row["flags"].split() == document["flags"]
        assert [row["lambda"], row["mu"]] == document["turns"]
        names = ("roll", "pitch", "phase", "drop", "embedment", "pivot_offset")
        assert [row[name] for name in names] == [document[name] for name in names]  # type: ignore[literal-required]
        assert {name: row[f"margin_{name}"] for name in document["margins"]} == document["margins"]
        for stage, pose in enumerate(document["poses"], 1):
            assert [[row[f"pose_{stage}_r{i}{j}"] for j in (1, 2, 3)] for i in (1, 2, 3)] == pose["rotation"]
            assert [row[f"pose_{stage}_t{axis}"] for axis in "xyz"] == pose["translation"]
        assert row["contacts"] == len(document["contacts"])
        for place, contact in enumerate(document["contacts"], 1):
            for name, value in contact.items():
                if isinstance(value, list):
                    assert [row[f"contact_{place}_{name}_{axis}"] for axis in "xyz"] == value
                else:
                    assert row[f"contact_{place}_{name}"] == value
        absent = [f"pose_{stage}_" for stage in range(len(document["poses"]) + 1, 4)]
        absent += [f"contact_{place}_" for place in range(len(document["contacts"]) + 1, 5)]
        assert all(value is None for name, value in row.items() if name.startswith(tuple(absent)))


def test_parquet_says_units_and_where_it_is_from(engine: Engine) -> None:
    library = record(engine, 2)
    schema = parquet.read_schema(
        io.BytesIO(content(engine, library, TableName.INTERVALS, FileFormat.PARQUET, LengthUnit.MILLIMETRE))
    )
    assert schema.metadata[b"content_sha256"].decode() == library.content_sha256
    assert schema.metadata[b"length_unit"] == b"mm"
    assert schema.field("start").metadata[b"unit"] == b"deg"
    assert schema.field("first_height").metadata[b"unit"] == b"length"
    assert schema.field("in_window").metadata[b"meaning"].startswith(b"whether")


def test_the_same_asked_for_twice_is_the_same_bytes_under_the_same_tag(engine: Engine) -> None:
    library = record(engine, 2)
    tags = {}
    for table in TableName:
        for file_format in FileFormat:
            for unit in LengthUnit:
                first, again = (content(engine, library, table, file_format, unit) for _ in range(2))
                assert first == again
                tags[table, file_format, unit] = file_sha256(library, table, file_format, unit)
    assert len(set(tags.values())) == len(tags)
    other = file_sha256(record(engine, 1), TableName.STATES, FileFormat.CSV, INCH)
    assert other not in tags.values()


def test_no_more_than_a_batch_is_read_before_it_is_given(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between two parts there is no transaction, and each one of them is a batch."""
    monkeypatch.setattr(read, "STATES_AT_ONCE", 10)
    monkeypatch.setattr(parquet_module, "ROWS_IN_A_GROUP", 20)
    library = record(engine, 1)
    begun: list[object] = []

    def remember(connection: object) -> None:
        begun.append(connection)

    event.listen(engine, "begin", remember)
    for file_format, states_in_a_part in ((FileFormat.CSV, 10), (FileFormat.NDJSON, 10), (FileFormat.PARQUET, 20)):
        parts = file_parts(engine, library, TableName.STATES, file_format, INCH)
        before = len(begun)
        if file_format is FileFormat.CSV:
            next(parts)  # the header
        for number in range(1, 4):
            next(parts)
            read_so_far = len(begun) - before
            assert read_so_far == number * states_in_a_part / 10
            assert engine.pool.checkedout() == 0  # type: ignore[attr-defined]
    event.remove(engine, "begin", remember)


@pytest.mark.parametrize("file_format", FileFormat)
def test_a_library_that_is_removed_meanwhile_is_no_file(
    one_library: tuple[Engine, LibraryRecord], file_format: FileFormat, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parquet_module, "ROWS_IN_A_GROUP", 512)
    engine, library = one_library
    parts = file_parts(engine, library, TableName.STATES, file_format, INCH)
    next(parts)
    with engine.begin() as connection:
        connection.execute(library_table.delete())
    with pytest.raises(NotFoundError, match=f"library {library.id}"):
        list(parts)


def test_without_pyarrow_the_extra_is_named(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    library = record(engine, 1)
    with pytest.raises(MissingExtraError, match=r"pip install '\.\[parquet\]'"):
        content(engine, library, TableName.STATES, FileFormat.PARQUET)
    with pytest.raises(MissingExtraError):
        file_sha256(library, TableName.STATES, FileFormat.PARQUET, INCH)
    assert content(engine, library, TableName.UNDECIDED, FileFormat.CSV) == b"roll,pitch,phase,reason\r\n"
