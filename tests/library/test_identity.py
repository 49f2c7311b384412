from __future__ import annotations

import ast
import importlib.metadata
import json
import math
import shutil
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

import threadstate
from threadstate.errors import InvalidValueError
from threadstate.library import identity
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs, canonical_json, physics_sha256
from threadstate.mesh.options import Descent, MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.state.solve import SolveOptions
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc

INPUTS = LibraryInputs(quarter_twenty_unc(), Grid(), SolveOptions())
BY_MESH = replace(INPUTS, mesh=MeshOptions())


def test_equal_inputs_have_one_hash() -> None:
    assert LibraryInputs(quarter_twenty_unc(), Grid(4, 1, 1), SolveOptions()).sha256 == INPUTS.sha256


def test_every_input_changes_the_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    pair = quarter_twenty_unc()
    variants = [
        INPUTS,
        replace(INPUTS, pair=quarter_twenty_unc(RootForm.NEWER)),
        replace(INPUTS, pair=replace(pair, fit=replace(pair.fit, nut_major_diameter=math.nextafter(0.25, 1.0)))),
        replace(INPUTS, pair=replace(pair, form=replace(pair.form, bolt_crest_fillet=0.05))),
        replace(INPUTS, grid=Grid(4.0, 1.0, 2.0)),
        replace(INPUTS, grid=Grid(4.0, 2.0, 1.0)),
        replace(INPUTS, grid=Grid(3.0, 1.0, 1.0)),
        replace(INPUTS, options=replace(INPUTS.options, quasi_stable_fraction=0.2)),
        BY_MESH,
        replace(BY_MESH, mesh=MeshOptions(tessellation=Preset.COARSE.tessellation)),
        replace(BY_MESH, mesh=MeshOptions(descent=Descent.DECADES)),
    ]
    hashes = {inputs.sha256 for inputs in variants}
    assert len(hashes) == len(variants)
    monkeypatch.setattr(identity, "version_of_code", lambda patterns, _: f"another{len(patterns)}")
    changed = {LibraryInputs(pair, Grid(), SolveOptions(), mesh).sha256 for mesh in (None, MeshOptions())}
    assert len(changed) == 2
    assert changed.isdisjoint(hashes)


def test_the_pair_is_written_down_whole() -> None:
    pair = json.loads(INPUTS.pair_json)
    assert pair["fit"]["nut_minor_diameter"] == 0.196
    assert pair["form"]["flank_half_angle_deg"] == 30.0
    assert pair["unit"] == "in"


@dataclass(frozen=True)
class _Numbers:
    second: float
    first: float


def test_canonical_json_is_the_same_for_equal_values() -> None:
    assert canonical_json(_Numbers(1, -0.0)) == canonical_json(_Numbers(1.0, 0.0)) == '{"first":0.0,"second":1.0}'


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_what_has_no_canonical_form_is_named(value: float) -> None:
    with pytest.raises(InvalidValueError, match="first"):
        canonical_json(_Numbers(1.0, value))


def test_a_change_of_the_physics_makes_another_code_version(tmp_path: Path) -> None:
    package = Path(threadstate.__file__).parent
    copy = tmp_path / "threadstate"
    shutil.copytree(package, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = physics_sha256(package)
    assert physics_sha256(copy) == before
    for unrelated in ("library/tables.py", "library/read.py", "history/heights.py", "settings.py"):
        with (copy / unrelated).open("a") as file:
            file.write("# changed\n")
    assert physics_sha256(copy) == before
    seen = {before}
    parts = (
        "thread/profile.py",
        "state/model.py",
        "state/document.py",
        "contact/__init__.py",
        "history/falls.py",
        "history/window.py",
        "network/from_history.py",
        "stored_histories/rows.py",
        "library/rows.py",
        "errors.py",
    )
    for part in parts:
        with (copy / part).open("a") as file:
            file.write("# changed\n")
        seen.add(physics_sha256(copy))
    assert len(seen) == len(parts) + 1


def test_the_options_of_meshes_are_written_down_with_those_of_every_method() -> None:
    options = json.loads(BY_MESH.options_json)
    assert json.loads(INPUTS.options_json).items() <= options.items()
    assert {"chord_height", "angle_control", "descent", "final_step", "tangent", "python-fcl"} <= set(options)


def test_a_change_of_the_mesh_method_changes_libraries_by_meshes_alone(tmp_path: Path) -> None:
    package = tmp_path / "threadstate"
    shutil.copytree(Path(threadstate.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    patterns = (identity.PHYSICS, identity.MESH_PHYSICS)
    exact, by_mesh = (physics_sha256(package, pattern) for pattern in patterns)
    with (package / "mesh" / "steps.py").open("a") as file:
        file.write("# changed\n")
    assert physics_sha256(package, identity.PHYSICS) == exact
    assert physics_sha256(package, identity.MESH_PHYSICS) != by_mesh


def test_a_change_of_histories_changes_libraries_by_the_exact_method_alone(tmp_path: Path) -> None:
    package = tmp_path / "threadstate"
    shutil.copytree(Path(threadstate.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    patterns = (identity.PHYSICS, identity.MESH_PHYSICS)
    exact, by_mesh = (physics_sha256(package, pattern) for pattern in patterns)
    with (package / "history" / "falls.py").open("a") as file:
        file.write("# changed\n")
    assert physics_sha256(package, identity.PHYSICS) != exact
    assert physics_sha256(package, identity.MESH_PHYSICS) == by_mesh


@pytest.mark.parametrize("library", ["numba", "llvmlite", "numpy"])
def test_another_version_of_what_computes_makes_another_library(monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    known = importlib.metadata.version
    before = INPUTS.code_version, BY_MESH.code_version
    identity.version_of_code.cache_clear()
    try:
        monkeypatch.setattr(
            "threadstate.library.identity.version", lambda name: "0.0" if name == library else known(name)
        )
        assert INPUTS.code_version != before[0]
        assert BY_MESH.code_version != before[1]
    finally:
        identity.version_of_code.cache_clear()


COMPUTING = ("threadstate/stored_histories/compute.py",)
"""What computes all that is stored."""

NO_PART_OF_THE_BITS = {
    "__init__.py": "the version, which is in the code version by itself",
    "_numba_cache.py": "where kernels are kept",
    "library/identity.py": "the inputs, which are in the hash by themselves",
    "numbers.py": "the text of numbers in messages",
    "library/solver_method.py": "the method's name, which is in the hash by itself",
}


def imported_by(start: tuple[str, ...], root: Path) -> set[str]:
    """The files of the package that these import, directly or not, and themselves."""
    found: set[str] = set()
    waiting = [root / name for name in start]
    while waiting:
        path = waiting.pop()
        name = path.relative_to(root / "threadstate").as_posix()
        if name in found:
            continue
        found.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            names: list[str] = []
            if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
            elif isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            for module in names:
                file = root / Path(*module.split("."))
                candidates = (file.with_suffix(".py"), file / "__init__.py")
                waiting += [one for one in candidates if module.startswith("threadstate") and one.is_file()]
    return found


def hashed(package: Path, patterns: tuple[str, ...]) -> set[str]:
    names = {path.relative_to(package).as_posix() for pattern in patterns for path in package.glob(pattern)}
    return names - set(identity.NOT_PHYSICS)


def test_all_that_stored_rows_are_computed_by_is_in_the_hash(repository_root: Path) -> None:
    package = repository_root / "threadstate"
    imported = imported_by(COMPUTING, repository_root)
    inits = {name for name in imported if name.endswith("/__init__.py")}
    exact = {name for name in imported if not name.startswith("mesh/")} - set(NO_PART_OF_THE_BITS) - inits
    assert exact <= hashed(package, identity.PHYSICS)
    assert set(NO_PART_OF_THE_BITS) <= imported
    of_states = ("thread/", "contact/", "state/", "mesh/")
    assert {name for name in imported if name.startswith(of_states)} <= hashed(package, identity.MESH_PHYSICS)
    # What computes nothing is not in it, so that its change does not cost everyone a new library.
    assert {name for name in hashed(package, identity.PHYSICS) if not name.endswith("__init__.py")} <= exact


def test_every_pattern_of_the_hash_finds_files(repository_root: Path) -> None:
    package = repository_root / "threadstate"
    for pattern in (*identity.PHYSICS, *identity.MESH_PHYSICS):
        assert any(package.glob(pattern)), pattern
    for name in identity.NOT_PHYSICS:
        assert (package / name).is_file(), name


def test_the_computing_process_computes_nothing_beside_it(repository_root: Path) -> None:
    """What is stored comes from one module of each kind alone: the worker imports no physics of its own.

    That a device can settle a pose is asked once, before the first chunk.
    """
    tree = ast.parse((repository_root / "worker" / "compute.py").read_text())
    modules = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module}
    assert {name for name in modules if name.startswith("threadstate")} == {
        *(f"threadstate.{kind}.compute" for kind in ("stored_histories", "settled", "success", "chances")),
        *("threadstate.library.identity", "threadstate.settled.inputs", "threadstate.chances.inputs"),
        "threadstate.device.settle",
    }
