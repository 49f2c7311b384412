"""What samples are computed from: valid ranges, and the hash of all of it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import threadstate
from tests.library.test_identity import hashed, imported_by
from threadstate.chances.inputs import PHYSICS, ChancesInputs
from threadstate.chances.sampling import Uncertainty
from threadstate.device.document import device_from_document
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.identity import physics_sha256
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

UNCERTAINTY = Uncertainty((0.0, 0.0), 1.0, (0.1, 0.2))
INPUTS = ChancesInputs(quarter_twenty_unc(), default_device(), Strategy.CW, UNCERTAINTY)


def test_every_input_changes_the_hash() -> None:
    changes: list[dict[str, Any]] = [
        {"pair": pair_by_designation("M6")},
        {"device": device_from_document({"unit": "mm", "k_tilt": 501.0})},
        {"strategy": Strategy.CCW_THEN_CW},
        {"uncertainty": replace(UNCERTAINTY, tilt_mean_deg=(0.0, 1.0))},
        {"uncertainty": replace(UNCERTAINTY, tilt_sd_deg=2.0)},
        {"uncertainty": replace(UNCERTAINTY, mu=(0.1, 0.3))},
        {"point_limit": 401},
    ]
    hashes = {INPUTS.sha256, *(replace(INPUTS, **change).sha256 for change in changes)}
    assert len(hashes) == len(changes) + 1
    same = replace(UNCERTAINTY, tilt_mean_deg=(-0.0, 0), tilt_sd_deg=1)
    assert replace(INPUTS, uncertainty=same).sha256 == INPUTS.sha256


@pytest.mark.parametrize("limit", [9, 2501])
def test_a_limit_outside_its_range_is_named(limit: int) -> None:
    with pytest.raises(InvalidValueError, match=f"point_limit is {limit}; valid: 10 to 2500"):
        replace(INPUTS, point_limit=limit)


def test_all_that_a_sample_is_computed_by_is_in_the_hash(repository_root: Path, tmp_path: Path) -> None:
    package = repository_root / "threadstate"
    imported = imported_by(("threadstate/chances/compute.py",), repository_root)
    no_part = {"_numba_cache.py", "numbers.py", "settings.py"}
    assert {name for name in imported if not name.endswith("__init__.py")} - no_part <= hashed(package, PHYSICS)
    for pattern in PHYSICS:
        assert any(package.glob(pattern)), pattern
    copy = tmp_path / "threadstate"
    shutil.copytree(Path(threadstate.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = physics_sha256(copy, PHYSICS)
    for name, changes in (("chances/network.py", False), ("chances/record.py", True), ("device/assemble.py", True)):
        with (copy / name).open("a") as file:
            file.write("# changed\n")
        assert (physics_sha256(copy, PHYSICS) != before) is changes
