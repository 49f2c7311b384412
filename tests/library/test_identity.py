from __future__ import annotations

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
    monkeypatch.setattr(identity, "_code_version", lambda patterns: f"another{len(patterns)}")
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
    for unrelated in ("library/tables.py", "state/document.py", "settings.py"):
        with (copy / unrelated).open("a") as file:
            file.write("# changed\n")
    assert physics_sha256(copy) == before
    seen = {before}
    for part in ("thread/profile.py", "state/model.py", "contact/__init__.py"):
        with (copy / part).open("a") as file:
            file.write("# changed\n")
        seen.add(physics_sha256(copy))
    assert len(seen) == 4


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
