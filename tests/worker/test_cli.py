from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

import threadstate
from tests.worker.conftest import COMMAND, CommandLine
from threadstate.errors import UnresolvedPoseError
from threadstate.mesh.options import Descent, MeshOptions, Scene, Tangent
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import solve_poses_by_mesh
from threadstate.state.document import state_document
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc, source_of
from threadstate.thread.pair import Pair
from threadstate.thread.standards.sizes import UNIFIED_SOURCE
from threadstate.units import LengthUnit, conversion_factor
from worker.cli import PROGRAM, command_group
from worker.commands.solve import BATCH
from worker.exit_codes import ExitCode

pytestmark = pytest.mark.sqlite_alone

UNC = quarter_twenty_unc()
POSE = ["--roll", "4", "--pitch", "0", "--phase", "185"]


def _line(state: ContactState, unit: LengthUnit = LengthUnit.INCH, source: str = UNIFIED_SOURCE) -> str:
    """The line that a state is printed as."""
    document = state_document(state, conversion_factor(LengthUnit.INCH, unit))
    return json.dumps({**document, "unit": unit.value, "source": source}, separators=(",", ":")) + "\n"


COMMANDS = sorted(command_group().commands)


def _options(name: str) -> Iterator[str]:
    for parameter in command_group().commands[name].params:
        yield from (name for name in parameter.opts if name.startswith("-"))


def _sections(text: str) -> dict[str, str]:
    parts = re.split(r"^### `threadstate ([a-z-]+)`$", text, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_and_option_is_documented(repository_root: Path, name: str) -> None:
    section = _sections((repository_root / "docs" / "cli.md").read_text())[name].split("## Exit codes")[0]
    documented = set(re.findall(r"`(--[a-z-]+)(?: [A-Z=,:]+)?`", section))
    assert documented - {"--json"} == set(_options(name)) - {"--json"}
    assert ("--json" in documented) == ("--json" in set(_options(name))) or name == "run"


def test_no_command_is_documented_that_is_not_there(repository_root: Path) -> None:
    assert sorted(_sections((repository_root / "docs" / "cli.md").read_text())) == COMMANDS


@pytest.mark.parametrize(("page", "least"), [("README.md", 1), ("docs/tutorial.md", 10), ("docs/cli.md", 3)])
def test_every_command_shown_is_there_with_its_options(repository_root: Path, page: str, least: int) -> None:
    text = (repository_root / page).read_text()
    commands = [shlex.split(line) for line in re.findall(r"^(?:\$ )?threadstate ([a-z].*)$", text, re.MULTILINE)]
    assert len(commands) >= least
    for name, *arguments in commands:
        assert name in COMMANDS
        assert {one for one in arguments if one.startswith("--")} <= set(_options(name)), name


def test_every_exit_code_is_documented(repository_root: Path) -> None:
    text = (repository_root / "docs" / "cli.md").read_text()
    documented = {(int(code), name) for code, name in re.findall(r"^\| (\d+) \| `([A-Z_]+)` \|", text, re.M)}
    assert documented == {(code.value, code.name) for code in ExitCode}


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_examples_that_fit_the_command(command_line: CommandLine, name: str) -> None:
    code, out, _ = command_line.here(name, "--help")
    examples = re.findall(rf"^ +{PROGRAM} (.*)$", out.split("Examples:")[1].split("Options:")[0], re.M)
    assert code == 0
    assert examples
    for example in examples:
        command, *arguments = example.split()
        assert command == name
        assert {argument for argument in arguments if argument.startswith("--")} <= set(_options(name))


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_help_lists_the_commands(command_line: CommandLine, arguments: list[str]) -> None:
    code, out, _ = command_line.here(*arguments)
    assert code == 0
    assert all(re.search(rf"^  {name} ", out, re.M) for name in COMMANDS)


@pytest.mark.parametrize("columns", ["40", "80", "200"])
def test_no_description_of_the_overview_is_cut(
    command_line: CommandLine, monkeypatch: pytest.MonkeyPatch, columns: str
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    _, out, _ = command_line.here("--help")
    assert "..." not in out.partition("Commands:")[2]
    told = " ".join(out.split())
    for name in COMMANDS:
        text = command_group().commands[name].help
        assert text is not None
        assert " ".join(text.split("\n\n")[0].split()) in told


def test_a_command_is_described_when_it_is_looked_up(environment: Mapping[str, str]) -> None:
    script = (
        "from unittest import mock; import worker.cli as cli\n"
        "with mock.patch.object(cli, 'get_command_from_info', wraps=cli.get_command_from_info) as described:\n"
        "    cli.run_command_line(['key', '--help']); print(described.call_count)\n"
        "    cli.run_command_line(['--help']); print(described.call_count == len(cli.COMMANDS))"
    )
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert (lines.count("1"), lines[-1]) == (1, "True")


def test_help_loads_nothing_heavy(environment: Mapping[str, str]) -> None:
    script = (
        "import sys; from worker.cli import run_command_line; run_command_line(['rebuild', '--help'])\n"
        "heavy = ('numba', 'numpy', 'matplotlib', 'sqlalchemy', 'alembic', 'service')\n"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_pose_is_one_object(command_line: CommandLine) -> None:
    code, out, err = command_line.here("solve", *POSE, "--json")
    assert (code, err) == (0, "")
    assert out == _line(solve_pose(UNC, 4.0, 0.0, 185.0))
    assert list(json.loads(out))[:4] == ["roll", "pitch", "phase", "class"]


def test_poses_of_a_file_are_one_object_a_line_in_its_order(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    poses = [(1.0, -2.0, 10.0 * step) for step in range(20, 0, -1)]
    path.write_text("roll,pitch,phase\n" + "".join(f"{roll},{pitch},{phase}\n" for roll, pitch, phase in poses))
    code, out, _ = command_line.here("solve", "--poses", str(path), "--json")
    assert code == 0
    assert out == "".join(_line(solve_pose(UNC, *pose)) for pose in poses)


def test_a_named_pair_is_solved(command_line: CommandLine) -> None:
    name = "1/4-20 UNC newer root"
    _, out, _ = command_line.here("solve", *POSE, "--pair", name, "--json")
    pair = pair_by_designation(name)
    source = source_of(pair)
    assert source is not None
    assert out == _line(solve_pose(pair, 4.0, 0.0, 185.0), source=source)


@pytest.mark.slow
def test_a_pose_is_solved_by_meshes(command_line: CommandLine) -> None:
    chosen = ["--preset", "coarse", "--descent", "decades", "--final-step", "10uin", "--tangent", "azimuthal"]
    chosen += ["--scene", "edges"]
    code, out, err = command_line.here("solve", *POSE, "--method", "mesh", *chosen, "--json")
    options = MeshOptions(Preset.COARSE.tessellation, Descent.DECADES, 2e-4, Tangent.AZIMUTHAL, Scene.EDGES)
    assert (code, err) == (0, "")
    assert out == _line(solve_poses_by_mesh(UNC, [(4.0, 0.0, 185.0)], options)[0])
    assert "stable" in command_line.here("solve", *POSE, "--method", "mesh")[1]


def test_a_pose_that_meshes_cannot_answer_ends_with_5(command_line: CommandLine) -> None:
    level = ["--roll", "0", "--pitch", "0", "--phase", "0"]
    code, out, err = command_line.here("solve", *level, "--method", "mesh", "--preset", "coarse")
    assert (code, out) == (ExitCode.UNRESOLVED, "")
    assert "phase 0.0 deg: a level bolt in phase rests on a strip of its thread" in err


def test_without_json_a_pose_is_a_table(command_line: CommandLine) -> None:
    code, out, _ = command_line.here("solve", *POSE)
    state = solve_pose(quarter_twenty_unc(), 4.0, 0.0, 185.0)
    assert code == 0
    assert state.state_class.value in out
    assert f"{state.contacts[0].point[0]:.6f}" in out
    assert len(out.splitlines()) == 3 + len(state.contacts)
    in_mm = command_line.here("solve", *POSE, "--unit", "mm")[1]
    assert "x (mm)" in in_mm
    assert f"{state.contacts[0].point[0] * 25.4:.5f}" in in_mm
    assert command_line.here("solve", *POSE, "--unit", "mm", "--json")[1] == _line(state, LengthUnit.MILLIMETRE)


def test_a_phase_of_another_turn_is_shown_in_this_one(command_line: CommandLine) -> None:
    row = command_line.here("solve", "--roll", "4", "--pitch", "0", "--phase", "-175")[1].splitlines()[1]
    assert row.split()[:3] == ["4", "0", "185"]


def test_the_version_is_the_packages(command_line: CommandLine) -> None:
    assert command_line.here("--version") == (0, f"{PROGRAM} {threadstate.__version__}\n", "")


@pytest.mark.parametrize("options", [[], ["--json"]])
def test_a_file_without_poses_has_no_answers(command_line: CommandLine, tmp_path: Path, options: list[str]) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("roll,pitch,phase\n")
    code, out, err = command_line.here("solve", "--poses", str(path), *options)
    assert (code, err) == (0, "")
    assert "stable" not in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["no-such-command"], "No such command 'no-such-command'"),
        (["solve", "--no-such-option"], "No such option"),
        (["solve", "--roll", "4"], "--pitch"),
        (["solve", "--roll", "x", "--pitch", "0", "--phase", "0"], "--roll"),
        (["solve", "--roll", "11", "--pitch", "0", "--phase", "0"], "roll is 11.0; valid: -10"),
        (["solve", "--roll", "0", "--pitch", "nan", "--phase", "0"], "'--pitch': 'nan' is not a decimal number"),
        (["solve", "--roll", "0", "--pitch", "0", "--phase", "inf"], "'--phase': 'inf' is not a decimal number"),
        (["solve", *POSE, "--pair", "M7"], "designation is 'M7'; valid: a standard thread"),
        (["solve", *POSE, "--poses", "poses.csv"], "not both"),
        (["solve", *POSE, "--method", "guess"], "'guess' is not one of"),
        (["solve", *POSE, "--preset", "fine"], "--preset is 'fine'; valid: a setting of --method mesh alone"),
        (["solve", *POSE, "--method", "mesh", "--final-step", "2uin"], "'2uin' is not one of"),
        (["solve", *POSE, "--scene", "curves"], "--scene is 'curves'; valid: a setting of --method mesh alone"),
        (["solve", "--poses", "no-such-file.csv"], "no-such-file.csv"),
        (["rebuild", "--phase-step", "7"], "phase_step is 7.0; valid: a step that divides 360 deg evenly"),
        (["rebuild", "--tilt-max", "11"], "tilt_max is 11.0; valid: 0 to 10 deg"),
        (["rebuild", "--workers", "0"], "--workers"),
        (["rebuild", "--database", "threads.sqlite3"], "database is 'threads.sqlite3'"),
        (["serve", "--port", "70000"], "--port"),
    ],
)
def test_a_bad_value_ends_with_2_and_one_line(command_line: CommandLine, arguments: list[str], message: str) -> None:
    code, out, err = command_line.here(*arguments)
    assert (code, out) == (ExitCode.USAGE, "")
    assert message in err
    assert err.startswith(f"{PROGRAM}: ")
    assert len(err.splitlines()) == 1


def test_a_pose_that_cannot_be_decided_ends_with_5(
    command_line: CommandLine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def undecided(_pair: Pair, poses: list[tuple[float, float, float]]) -> list[ContactState]:
        if len(poses) < BATCH:
            raise UnresolvedPoseError(*poses[0])
        return solve_poses(quarter_twenty_unc(), poses[:1]) * len(poses)

    path = tmp_path / "poses.csv"
    path.write_text("roll,pitch,phase\n" + "4,0,185\n" * BATCH + "1,2,3\n")
    monkeypatch.setattr("threadstate.state.solve.solve_poses", undecided)
    code, out, err = command_line.here("solve", "--poses", str(path), "--json")
    assert code == ExitCode.UNRESOLVED
    assert len(out.splitlines()) == BATCH
    assert "roll 1.0, pitch 2.0, phase 3.0 deg" in err
    assert len(err.splitlines()) == 1


def test_a_folder_that_cannot_be_made_is_a_bad_value(command_line: CommandLine, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    code, _, err = command_line.here("migrate", "--database", f"sqlite:///{tmp_path / 'file' / 'x.sqlite3'}")
    assert code == ExitCode.USAGE
    assert len(err.splitlines()) == 1


@pytest.mark.slow
def test_a_reader_that_has_enough_is_no_traceback(environment: Mapping[str, str], tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("roll,pitch,phase\n" + "1,2,3\n" * 200)
    with subprocess.Popen(
        [*COMMAND, "solve", "--poses", str(path), "--json"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.wait(timeout=300) == ExitCode.FAILURE
        assert process.stderr.read() == ""
