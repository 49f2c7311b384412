from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import Engine

import worker.sweep.run
from tests.worker.conftest import CommandLine
from threadstate.errors import InvalidValueError
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import jobs_before
from threadstate.library.engine import reading
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import LARGEST_ID, library_by_input, published_libraries
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from worker.processes import ComputeError
from worker.rebuild import Progress, RebuildResult, rebuild
from worker.sweep.document import TABLES, read_sweep

pytestmark = pytest.mark.sqlite_alone

EXAMPLE = "examples/sweep.toml"

OWN_PAIR = """
[[pair]]
designation = "M6 of one's own"
unit = "mm"
nominal_diameter = 6
thread_pitch = 1.0
[pair.form]
name = "ISO"
flank_half_angle_deg = 30.0
bolt_root_fillet = 0.108
bolt_crest_fillet = 0.054
nut_root_fillet = 0.054
nut_crest_fillet = 0.108
[pair.fit]
name = "6g/6H"
bolt_major_diameter = 5.974
bolt_pitch_diameter = 5.324
bolt_minor_diameter = 4.77
nut_major_diameter = 6.0
nut_pitch_diameter = 5.35
nut_minor_diameter = 4.917
"""

SMALL = """
[[pair]]
designation = "1/4-20 UNC"

[[pair]]
designation = "1/4-20 UNC newer root"

[[grid]]
tilt_max = 0
phase_step = 90
"""


def _read(tmp_path: Path, text: str) -> tuple[LibraryInputs, ...]:
    path = tmp_path / "sweep.toml"
    path.write_text(text)
    return read_sweep(path)


@pytest.fixture
def small(tmp_path: Path) -> str:
    """A file of two libraries of four poses."""
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return str(path)


def test_pairs_grids_and_methods_are_crossed(tmp_path: Path) -> None:
    grid = "[[grid]]\ntilt_max = 1\n[[grid]]\nphase_step = 0.5\n"
    method = '[[method]]\n[[method]]\nname = "mesh"\nmesh = {preset = "coarse"}\n'
    found = _read(tmp_path, '[[pair]]\ndesignation = "1/4-20 UNC"\n' + OWN_PAIR + grid + method)
    assert [(one.pair.designation, one.grid, one.method) for one in found] == [
        (designation, grid, method)
        for designation in ("1/4-20 UNC", "M6 of one's own")
        for grid in (Grid(1.0, 1.0, 1.0), Grid(4.0, 1.0, 0.5))
        for method in (SolverMethod.EXACT, SolverMethod.MESH)
    ]
    assert found[0] == LibraryInputs(quarter_twenty_unc(), Grid(1.0, 1.0, 1.0), SolveOptions())
    assert found[1].mesh == MeshOptions(tessellation=Preset.COARSE.tessellation)
    assert found[-1].pair.fit.nut_minor_diameter == 4.917


def test_what_is_not_said_is_as_of_a_rebuild(tmp_path: Path) -> None:
    (found,) = _read(tmp_path, '[[pair]]\ndesignation = "1/4-20 UNC newer root"\n')
    assert found == LibraryInputs(quarter_twenty_unc(RootForm.NEWER), Grid(), SolveOptions())


def test_a_list_crosses_nothing(tmp_path: Path) -> None:
    library = '[[library]]\npair = "{}"\ngrid = {{tilt_max = 1, phase_step = {}}}\n'
    found = _read(tmp_path, OWN_PAIR + library.format("1/4-20 UNC", 5) + library.format("M6 of one's own", 10))
    assert [(one.pair.designation, one.grid.phase_step_deg) for one in found] == [
        ("1/4-20 UNC", 5.0),
        ("M6 of one's own", 10.0),
    ]


def test_fits_of_a_pair_are_pairs_that_are_like_it_otherwise(repository_root: Path) -> None:
    known, tight, loose = (one.pair for one in read_sweep(repository_root / EXAMPLE)[::2])
    assert [one.designation for one in (known, tight, loose)] == [
        "1/4-20 UNC",
        "1/4-20 UNC tight bolt",
        "1/4-20 UNC loose nut",
    ]
    assert tight.form == loose.form == known.form
    assert (tight.fit.bolt_pitch_diameter, tight.fit.nut_pitch_diameter) == (0.2170, known.fit.nut_pitch_diameter)
    assert (loose.fit.bolt_pitch_diameter, loose.fit.nut_pitch_diameter) == (known.fit.bolt_pitch_diameter, 0.2190)


def test_the_same_library_twice_is_one(tmp_path: Path) -> None:
    assert len(_read(tmp_path, SMALL + "[[grid]]\ntilt_max = 0\ntilt_step = 1.0\nphase_step = 90.0\n")) == 2


KNOWN = '[[pair]]\ndesignation = "1/4-20 UNC"\n'


@pytest.mark.parametrize(
    ("text", "name", "value", "valid"),
    [
        ("", "pair", "None", "one pair at least"),
        ("pair = 3", "pair", "3", "a valid list"),
        ("pair = [3]", "pair[1]", "3", "a valid table"),
        ("[[pairs]]", "pairs", "[{}]", "one of the keys pair, grid, method, library"),
        ("[[pair]]", "pair[1].designation", "None", "a value"),
        ('[[pair]]\ndesignation = "M7"', "pair[1].designation", "'M7'", "1/4-20 UNC newer root"),
        ('[[pair]]\ndesignation = "M7"\nlike = "M51"', "pair[1].like", "'M51'", "1/4-20 UNC"),
        ('[[pair]]\ndesignation = "M7"\nunit = "mm"', "pair[1].form.name", "None", "a value, or a known pair"),
        ('[[pair]]\ndesignation = "M7"\nunit = "m"', "pair[1].unit", "'m'", "'in' or 'mm'"),
        (KNOWN + "nominal_diameter = 0.25\nlike = '1/4-20 UNC'", "pair[1].designation", "'1/4-20 UNC'", "one's own"),
        (KNOWN + KNOWN, "pair[2].designation", "'1/4-20 UNC'", "each designation once"),
        (OWN_PAIR + "fits = 1", "pair[1].fit.fits", "1", "one of the keys name, bolt_major_diameter"),
        (OWN_PAIR.replace("5.324", "5.4"), "pair[1].fit.bolt_pitch_diameter", "5.4", "at most the nut's, 5.35"),
        (OWN_PAIR.replace("5.324", "'5.3'"), "pair[1].fit.bolt_pitch_diameter", "'5.3'", "a valid number"),
        (OWN_PAIR.replace("5.324", "nan"), "pair[1].fit.bolt_pitch_diameter", "nan", "a finite number"),
        (OWN_PAIR.replace("= 30.0", "= 90"), "pair[1].form.flank_half_angle_deg", "90.0", "0 < angle < 90 deg"),
        (OWN_PAIR.replace("= 1.0", "= -1"), "pair[1].thread_pitch", "-1.0", "a finite length > 0"),
        (
            '[[pair]]\ndesignation = "x"\nlike = "1/4-20 UNC"\n[[pair.fits]]\n[[pair.fits]]\nbolt_major_diameter = 1',
            "pair[1].fits[2].bolt_major_diameter",
            "1.0",
            "at most the nut's, 0.25",
        ),
        (KNOWN + "[[grid]]\nphase_step = 0.7", "grid[1].phase_step", "0.7", "divides 360 deg evenly"),
        (KNOWN + "[[grid]]\n[[grid]]\ntilt_max = 11", "grid[2].tilt_max", "11.0", "0 to 10 deg"),
        (KNOWN + "[[grid]]\ntilt = 1", "grid[1].tilt", "1", "one of the keys tilt_max, tilt_step, phase_step"),
        (KNOWN + '[[method]]\nname = "guess"', "method[1].name", "'guess'", "'exact' or 'mesh'"),
        (KNOWN + "[[method]]\nmesh = {}", "method[1].mesh", "'given'", "of the method `mesh` alone"),
        (
            KNOWN + "[[method]]\ntolerances = {tie_tolerance = 1}",
            "method[1].tolerances.tie_tolerance",
            "1.0",
            "1e-14 to 0.0001",
        ),
        ('[[library]]\npair = "M7"', "library[1].pair", "'M7'", "1/4-20 UNC"),
        ('[[grid]]\n[[library]]\npair = "1/4-20 UNC"', "grid", "'given'", "within [[library]]"),
    ],
)
def test_what_is_not_valid_is_named_with_its_place(
    tmp_path: Path, text: str, name: str, value: str, valid: str
) -> None:
    with pytest.raises(InvalidValueError) as caught:
        _read(tmp_path, text)
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'sweep.toml'}: {name} is {value}; valid: ")
    assert valid in message


@pytest.mark.parametrize(("content", "valid"), [(None, "read"), (b"pair", "TOML"), (b"\xff", "UTF-8")])
def test_what_is_no_toml_file_is_refused(tmp_path: Path, content: bytes | None, valid: str) -> None:
    path = tmp_path / "sweep.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InvalidValueError, match=rf"file is '{re.escape(str(path))}'; valid: .*{valid}"):
        read_sweep(path)


def test_every_key_of_the_file_is_documented(repository_root: Path) -> None:
    text = (repository_root / "docs/sweeps.md").read_text().split("## The file")[1]
    named = set(re.findall(r"`\[*([a-z_]+)\]*`", text))
    keys = {key for part in TABLES.values() for key in part.model_fields} | set(TABLES)
    long = {f"{side}_{which}" for side in ("bolt", "nut") for which in ("major", "pitch", "minor")}
    assert {key for key in keys if key.removesuffix("_diameter") not in long} <= named


def test_a_sweep_is_computed_once(command_line: CommandLine, small: str) -> None:
    first = [json.loads(line) for line in command_line.out("sweep", small, "--workers", "1", "--json").splitlines()]
    assert [one["outcome"] for one in first] == ["published"] * 2
    again = [json.loads(line) for line in command_line.out("sweep", small, "--json").splitlines()]
    assert [one["outcome"] for one in again] == ["there"] * 2
    with reading(command_line.database) as engine, engine.connect() as connection:
        for inputs, one in zip(read_sweep(Path(small)), first, strict=True):
            library = library_by_input(connection, inputs.sha256)
            assert library is not None
            assert (library.id, library.content_sha256) == (one["library"], one["content_sha256"])
            assert library.designation == one["pair"] == inputs.pair.designation
    told = [json.loads(line) for line in command_line.out("sweep", small, "--dry-run", "--json").splitlines()]
    assert [(one["state"], one["seconds"]) for one in told] == [("there", 0.0)] * 2


def test_the_example_is_a_sweep(command_line: CommandLine, repository_root: Path) -> None:
    code, out, _ = command_line.here("sweep", str(repository_root / EXAMPLE), "--dry-run", "--json")
    assert code == 0
    assert [json.loads(line)["state"] for line in out.splitlines()] == ["new"] * 6


def test_a_dry_run_writes_nothing_and_counts_what_is_then_there(command_line: CommandLine, small: str) -> None:
    code, out, _ = command_line.here("sweep", small, "--dry-run", "--json")
    assert code == 0
    assert not Path(command_line.database.removeprefix("sqlite:///")).exists()
    told = [json.loads(line) for line in out.splitlines()]
    assert [(one["state"], one["poses"]) for one in told] == [("new", 4), ("new", 4)]
    for one in told:
        assert one["rows"] > one["poses"]
        assert one["bytes"] > one["rows"]
        assert one["seconds"] >= 0.0
    assert command_line.here("sweep", small, "--dry-run")[1].splitlines()[-1].startswith("2 libraries")


def test_one_that_fails_does_not_stop_the_others(
    command_line: CommandLine, small: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail_once(
        engine: Engine, inputs: LibraryInputs, workers: int, progress: Progress, scheduler: str | None
    ) -> RebuildResult:
        if inputs.pair == quarter_twenty_unc():
            raise ComputeError("a computing process died")
        return rebuild(engine, inputs, workers, progress, scheduler)

    monkeypatch.setattr(worker.sweep.run, "rebuild", fail_once)
    code, out, _ = command_line.here("sweep", small, "--workers", "1")
    assert code == 1
    failed, published = out.splitlines()
    assert failed.startswith("failed: 1/4-20 UNC, exact")
    assert failed.endswith(": a computing process died")
    assert published.startswith("published: 1/4-20 UNC newer root, exact")


def test_as_jobs_they_are_queued_once(command_line: CommandLine, small: str) -> None:
    told: list[list[dict[str, Any]]] = [
        [json.loads(line) for line in command_line.here("sweep", small, "--jobs", "--json")[1].splitlines()]
        for _ in range(2)
    ]
    assert told[0] == told[1]
    assert [(one["outcome"], one["job"]) for one in told[0]] == [("queued", 1), ("queued", 2)]
    with reading(command_line.database) as engine, engine.connect() as connection:
        assert [job.state for job in jobs_before(connection, LARGEST_ID, 10)] == [JobState.QUEUED] * 2
        assert published_libraries(connection) == []
    command_line.out("worker", "--until-idle", "--workers", "1")
    assert command_line.here("sweep", small, "--jobs")[1].count("there: ") == 2


def test_jobs_and_a_dry_run_exclude_each_other(command_line: CommandLine, small: str) -> None:
    code, _, err = command_line.here("sweep", small, "--jobs", "--dry-run")
    assert code == 2
    assert "--jobs is 'given'; valid: without --dry-run" in err
