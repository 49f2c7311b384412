"""Libraries of settled states: identity, rows, what is written and read back."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from sqlalchemy import Engine, select, update

import threadstate
from tests.library.test_identity import hashed, imported_by
from threadstate.device.document import device_from_document
from threadstate.device.model import Outcome, SettledFlag, SettledMargins, SettledState, default_device
from threadstate.device.settle import settle_poses
from threadstate.errors import NotFoundError
from threadstate.library.grid import Grid
from threadstate.library.identity import physics_sha256
from threadstate.library.settled_tables import settled_library, settled_state
from threadstate.library.write import IncompleteLibraryError
from threadstate.settled import inputs as settled_inputs
from threadstate.settled.compute import computed_rows
from threadstate.settled.inputs import PHYSICS, SettledInputs, device_of
from threadstate.settled.read import (
    SettledFilter,
    named_settled_library,
    settled_counts,
    settled_libraries,
    settled_library_by_input,
    settled_ordinals,
    settled_state_of_pose,
    settled_states_at,
    settled_states_between,
)
from threadstate.settled.rows import settled_rows, states_from_rows
from threadstate.settled.write import committed_settled, open_settled, publish_settled, write_settled
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import LengthUnit

PAIR = quarter_twenty_unc()
GRID = Grid(3.0, 3.0, 120.0)
INPUTS = SettledInputs(PAIR, GRID, default_device())
FALLEN = (-4.0, -4.0, 5.0)
POSES = ((0.0, 3.0, 250.0), (1.0, 0.5, 120.0), (0.0, 0.0, 0.5), (3.0, 3.0, 4.0), FALLEN)
UNDECIDED = SettledState(
    *(1.0, 2.0, 3.0),
    Outcome.UNDECIDED,
    (SettledFlag.FLUSH, SettledFlag.UNSTABLE),
    *(None, None, None),
    (),
    None,
    (),
    SettledMargins(None, None, None, None, None),
    (),
)


@pytest.fixture(scope="module")
def states() -> list[list[SettledState]]:
    """The settled states of the grid's orientations, without paths, one of them replaced by an undecided one."""
    found = [settle_poses(PAIR, GRID.poses(index)) for index in range(GRID.orientation_count)]
    roll_deg, pitch_deg, phase_deg = GRID.poses(4)[1]
    found[4][1] = replace(UNDECIDED, roll_deg=roll_deg, pitch_deg=pitch_deg, phase_deg=phase_deg)
    return [[replace(state, path=()) for state in of_orientation] for of_orientation in found]


def stored(writer: Engine, states: list[list[SettledState]], inputs: SettledInputs = INPUTS) -> int:
    """Publish a library of these states."""
    library_id = open_settled(writer, inputs)
    for index, of_orientation in enumerate(states):
        rows = settled_rows(GRID.orientation(index), GRID.first_ordinal(index), of_orientation)
        assert write_settled(writer, library_id, rows)
        assert not write_settled(writer, library_id, rows)
    publish_settled(writer, library_id, GRID)
    return library_id


def test_rows_give_back_every_bit() -> None:
    found = [replace(state, path=()) for state in (*settle_poses(PAIR, POSES), UNDECIDED)]
    assert {len(state.contacts) for state in found} >= {0, 1, 2, 3}
    assert any(state.falls for state in found)
    rows = settled_rows(GRID.orientation(0), 7, found)
    assert states_from_rows(rows.states, rows.contacts, rows.falls, rows.flags) == found
    assert [row[0] for row in rows.states] == list(range(7, 7 + len(found)))


def test_what_is_written_is_read_back(writer: Engine, reader: Engine, states: list[list[SettledState]]) -> None:
    library_id = stored(writer, states)
    whole = [state for of_orientation in states for state in of_orientation]
    with reader.connect() as connection:
        assert settled_states_between(connection, library_id, 0, GRID.pose_count - 1) == whole
        assert settled_states_at(connection, library_id, [2, 13, 26]) == [whole[2], whole[13], whole[26]]
        record = named_settled_library(connection, "latest")
        assert record == named_settled_library(connection, str(library_id)) == settled_libraries(connection)[0]
        assert settled_library_by_input(connection, INPUTS.sha256) == record
        assert (record.device, record.grid, record.length_unit) == (default_device(), GRID, LengthUnit.INCH)
        assert settled_state_of_pose(connection, record, 3.0, -3.0, 240.0) == whole[20]
        counts = settled_counts(connection, library_id)
        for pose in ((3.0, -3.0, 241.0), (4.0, -3.0, 240.0)):
            with pytest.raises(NotFoundError, match="has none at roll"):
                settled_state_of_pose(connection, record, *pose)
        for name in ("0", "99", "M6", "9" * 18):
            with pytest.raises(NotFoundError, match=rf"published are: {library_id}; `threadstate rebuild-settled`"):
                named_settled_library(connection, name)
    assert dict(counts.of_outcome) == {Outcome.SETTLED: 26, Outcome.SLIPPED: 0, Outcome.UNDECIDED: 1}
    assert dict(counts.of_flag)[SettledFlag.FLUSH] == sum(SettledFlag.FLUSH in state.flags for state in whole)
    of_contacts = {n: sum(len(state.contacts) == n for state in whole) for n in {len(one.contacts) for one in whole}}
    assert dict(counts.of_contacts) == of_contacts
    assert list(counts.of_contacts) == sorted(counts.of_contacts)
    assert sum(count for _, count in counts.of_falls) == 27


@pytest.mark.parametrize(
    "which",
    [
        SettledFilter(),
        SettledFilter(roll_deg=3.0),
        SettledFilter(roll_deg=0.0, pitch_deg=0.0),
        SettledFilter(pitch_deg=-3.0),
        SettledFilter(phase_deg=120.0),
        SettledFilter(phase_min_deg=100.0, phase_max_deg=130.0, roll_deg=-3.0),
        SettledFilter(outcome=Outcome.UNDECIDED),
        SettledFilter(outcome=Outcome.SETTLED, flag=SettledFlag.FLUSH),
        SettledFilter(contacts=2),
        SettledFilter(falls=0, contacts=1),
        SettledFilter(falls=7),
    ],
    ids=str,
)
def test_a_filter_keeps_what_it_says(
    writer: Engine, reader: Engine, states: list[list[SettledState]], which: SettledFilter
) -> None:
    library_id = stored(writer, states)

    def holds(state: SettledState) -> bool:
        wanted = (
            (which.roll_deg, state.roll_deg),
            (which.pitch_deg, state.pitch_deg),
            (which.phase_deg, state.phase_deg),
            (which.outcome, state.outcome),
            (which.contacts, len(state.contacts)),
            (which.falls, len(state.falls)),
        )
        return (
            all(value in (None, found) for value, found in wanted)
            and (which.phase_min_deg or 0.0) <= state.phase_deg <= (which.phase_max_deg or 360.0)
            and (which.flag is None or which.flag in state.flags)
        )

    whole = [state for of_orientation in states for state in of_orientation]
    expected = [ordinal for ordinal, state in enumerate(whole) if holds(state)]
    with reader.connect() as connection:
        assert settled_ordinals(connection, library_id, which, -1, 100) == expected
        pages: list[int] = []
        while page := settled_ordinals(connection, library_id, which, pages[-1] if pages else -1, 4):
            pages += page
    assert pages == expected


def test_a_library_that_is_not_whole_is_not_published(writer: Engine, states: list[list[SettledState]]) -> None:
    library_id = open_settled(writer, INPUTS)
    assert open_settled(writer, INPUTS) == library_id
    write_settled(writer, library_id, settled_rows(GRID.orientation(2), GRID.first_ordinal(2), states[2]))
    assert committed_settled(writer, library_id) == {2}
    with pytest.raises(IncompleteLibraryError, match="1 of 9 orientations and 3 of 27 poses"):
        publish_settled(writer, library_id, GRID)
    with writer.connect() as connection:
        assert settled_libraries(connection) == []
        assert settled_library_by_input(connection, INPUTS.sha256) is None


def test_the_latest_is_the_one_published_last_whatever_the_clock_says(
    writer: Engine, states: list[list[SettledState]]
) -> None:
    first = stored(writer, states)
    with writer.begin() as connection:
        one = select(settled_library.c.published_at).where(settled_library.c.id == first)
        later = connection.execute(one).scalar_one().replace(year=2100)
        connection.execute(update(settled_library).values(published_at=later))
    second = stored(writer, states, replace(INPUTS, device=device_from_document({"unit": "mm", "push": 5.0})))
    with writer.connect() as connection:
        assert [record.id for record in settled_libraries(connection)] == [second, first]
        assert named_settled_library(connection, "latest").device.push == 5.0


def test_the_states_of_a_library_go_with_it(writer: Engine, states: list[list[SettledState]]) -> None:
    stored(writer, states)
    with writer.begin() as connection:
        connection.execute(settled_library.delete())
    with writer.connect() as connection:
        assert connection.execute(select(settled_state.c.ordinal)).all() == []


def test_the_content_hash_is_of_every_value() -> None:
    def content(changed: SettledState) -> str:
        return settled_rows(GRID.orientation(0), 0, [changed]).content_sha256

    (state,) = settle_poses(PAIR, [FALLEN])
    assert state.pose is not None
    contact = state.contacts[0]
    x, y, z = contact.force
    variants = [
        state,
        replace(state, flags=(SettledFlag.MARGINAL,)),
        replace(state, outcome=Outcome.SLIPPED),
        replace(state, elastic_energy=1.0),
        replace(state, margins=replace(state.margins, force=0.25)),
        replace(state, contacts=(replace(contact, force=(x, y, z * (1.0 + 2.0**-52))), *state.contacts[1:])),
        replace(state, falls=()),
        replace(state, pose=replace(state.pose, translation=(0.0, 0.0, 0.0))),
    ]
    assert state.falls
    assert len({content(one) for one in variants}) == len(variants)
    assert content(replace(state, path=())) == content(state)


def test_every_input_changes_the_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    stiffer = device_from_document({"unit": "mm", "k_tilt": 501.0})
    variants = [
        INPUTS,
        replace(INPUTS, grid=Grid(3.0, 3.0, 60.0)),
        replace(INPUTS, pair=replace(PAIR, fit=replace(PAIR.fit, nut_pitch_diameter=0.2176))),
        replace(INPUTS, device=stiffer),
        replace(INPUTS, device=device_from_document({"unit": "mm", "about": "bolt"})),
        replace(INPUTS, device=device_from_document({"unit": "mm", "k_twist": 0.0})),
    ]
    hashes = {one.sha256 for one in variants}
    assert len(hashes) == len(variants)
    assert SettledInputs(PAIR, Grid(3.0, 3.0, 120.0), device_from_document({"unit": "mm"})).sha256 == INPUTS.sha256
    assert device_of(replace(INPUTS, device=stiffer).device_json) == stiffer
    monkeypatch.setattr(settled_inputs, "version_of_code", lambda *_: "another")
    assert SettledInputs(PAIR, GRID, default_device()).sha256 not in hashes


def test_all_that_settled_states_are_computed_by_is_in_the_hash(repository_root: Path, tmp_path: Path) -> None:
    package = repository_root / "threadstate"
    imported = imported_by(("threadstate/settled/compute.py",), repository_root)
    no_part = {"_numba_cache.py", "numbers.py", "settings.py"}
    assert {name for name in imported if not name.endswith("__init__.py")} - no_part <= hashed(package, PHYSICS)
    for pattern in PHYSICS:
        assert any(package.glob(pattern)), pattern
    copy = tmp_path / "threadstate"
    shutil.copytree(Path(threadstate.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = physics_sha256(copy, PHYSICS)
    for name, changes in (("device/document.py", False), ("settled/read.py", False), ("device/settle.py", True)):
        with (copy / name).open("a") as file:
            file.write("# changed\n")
        assert (physics_sha256(copy, PHYSICS) != before) is changes


def test_computed_rows_are_those_of_the_states() -> None:
    expected = settled_rows(GRID.orientation(5), 15, settle_poses(PAIR, GRID.poses(5)))
    assert computed_rows(PAIR, GRID, default_device(), 5) == expected
