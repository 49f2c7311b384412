"""What a success map is computed from: valid ranges, and the hash of all of it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import threadstate
from tests.library.test_identity import hashed, imported_by
from threadstate.device.document import device_from_document
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.identity import physics_sha256
from threadstate.success import inputs as success_inputs
from threadstate.success.inputs import PHYSICS, SuccessInputs
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
INPUTS = SuccessInputs(PAIR, default_device(), Strategy.CW, Grid(4.0, 4.0, 120.0))


def test_every_input_changes_the_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    changes: list[dict[str, Any]] = [
        {"pair": replace(PAIR, fit=replace(PAIR.fit, nut_pitch_diameter=0.2176))},
        {"device": device_from_document({"unit": "mm", "k_tilt": 501.0})},
        {"strategy": Strategy.CCW_THEN_CW},
        {"grid": Grid(4.0, 4.0, 60.0)},
        {"frictions": (0.1, 0.2)},
        {"phase_tolerance_deg": 1.0},
        {"mu_tolerance": 0.02},
        {"point_limit": 401},
    ]
    hashes = {INPUTS.sha256, *(replace(INPUTS, **change).sha256 for change in changes)}
    assert len(hashes) == len(changes) + 1
    assert replace(INPUTS, device=device_from_document({"unit": "mm"})).sha256 == INPUTS.sha256
    monkeypatch.setattr(success_inputs, "version_of_code", lambda *_: "another")
    assert INPUTS.sha256 in hashes
    assert replace(INPUTS).sha256 not in hashes


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"frictions": (0.1, 1.5)}, "mu is 1.5; valid: 0 to 1"),
        ({"frictions": (-0.1,)}, "mu is -0.1; valid: 0 to 1"),
        ({"frictions": (0.2, 0.1)}, "mu is '0.2,0.1'; valid: frictions that ascend"),
        ({"frictions": (0.1, 0.1)}, "mu is '0.1,0.1'; valid: frictions that ascend"),
        ({"frictions": ()}, "mu is ''; valid: frictions that ascend, at least one"),
        ({"phase_tolerance_deg": 0.0}, "phase_tolerance is 0.0; valid: 0.01 to 360 deg"),
        ({"mu_tolerance": 0.0}, "mu_tolerance is 0.0; valid: 0.0001 to 1"),
        ({"mu_tolerance": float("nan")}, "mu_tolerance is nan"),
        ({"point_limit": 9}, "point_limit is 9; valid: 10 to 2500"),
        ({"point_limit": 2501}, "point_limit is 2501; valid: 10 to 2500"),
    ],
)
def test_what_is_not_valid_is_named(change: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        replace(INPUTS, **change)
    assert words in str(caught.value)


def test_all_that_a_map_is_computed_by_is_in_the_hash(repository_root: Path, tmp_path: Path) -> None:
    package = repository_root / "threadstate"
    imported = imported_by(("threadstate/success/compute.py",), repository_root)
    no_part = {"_numba_cache.py", "numbers.py", "settings.py"}
    assert {name for name in imported if not name.endswith("__init__.py")} - no_part <= hashed(package, PHYSICS)
    for pattern in PHYSICS:
        assert any(package.glob(pattern)), pattern
    copy = tmp_path / "threadstate"
    shutil.copytree(Path(threadstate.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = physics_sha256(copy, PHYSICS)
    for name, changes in (("success/summary.py", False), ("success/search.py", True), ("device/assemble.py", True)):
        with (copy / name).open("a") as file:
            file.write("# changed\n")
        assert (physics_sha256(copy, PHYSICS) != before) is changes
