"""The study of what certainty costs: which setting is late, and what the page says of it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from studies.certainty.page import chart, late_counts, page, relative_times
from studies.certainty.study import (
    DEFAULT,
    EMBEDMENT,
    HEIGHT,
    LAMBDA,
    MU,
    SECONDS,
    SETTINGS,
    STATUS,
    Compared,
    Floats,
    Setting,
    compared,
    copy_package,
    drawn_poses,
)
from threadstate.contact._stage_kernel import RESOLVED, UNRESOLVED

NAME = "1/4-20 UNC"
OTHER = SETTINGS[0].name


def row(
    height: float = 0.01,
    second: float = 0.1,
    third: float = math.nan,
    embedment: float = math.nan,
    seconds: float = 1.0,
) -> Floats:
    """What is measured of a resolved pose."""
    one = np.zeros(6)
    one[[STATUS, HEIGHT, LAMBDA, MU, EMBEDMENT, SECONDS]] = RESOLVED, height, second, third, embedment, seconds
    return one


def results(in_use: list[Floats], other: list[Floats]) -> dict[str, dict[str, Compared]]:
    """Two settings, compared."""
    poses = {NAME: drawn_poses(len(in_use), [NAME])[NAME]}
    return compared(poses, {DEFAULT.name: {NAME: np.array(in_use)}, OTHER: {NAME: np.array(other)}})


@pytest.mark.parametrize(
    ("earlier", "later"),
    [
        (row(height=0.011), row(height=0.01)),
        (row(second=0.1), row(second=0.2)),
        (row(second=0.1), row(second=math.nan)),
        (row(third=0.1), row(third=math.nan)),
        (row(third=0.1), row(third=0.2)),
        (row(third=0.1, embedment=1e-3), row(third=0.1, embedment=0.0)),
        (row(height=0.011, second=0.2), row(height=0.01, second=0.1)),
    ],
)
def test_of_two_settings_the_one_with_the_earlier_contact_is_right(earlier: Floats, later: Floats) -> None:
    assert late_counts(results([earlier], [later])) == {DEFAULT.name: 0, OTHER: 1}
    assert late_counts(results([later], [earlier])) == {DEFAULT.name: 1, OTHER: 0}


def test_the_same_to_round_off_is_the_same_and_a_refused_pose_is_not_late() -> None:
    refused = row(height=0.0)
    refused[STATUS] = UNRESOLVED
    found = results([row(), row()], [row(height=0.01 * (1.0 + 1e-12)), refused])
    assert late_counts(found) == {DEFAULT.name: 0, OTHER: 0}
    assert found[OTHER][NAME].refused == 1


def test_a_setting_is_timed_on_the_poses_that_it_is_asked_for() -> None:
    not_asked = np.full(6, math.nan)
    found = results([row(seconds=2.0), row(seconds=9.0)], [row(seconds=5.0), not_asked])
    assert (found[OTHER][NAME].poses, found[OTHER][NAME].refused) == (1, 0)
    assert relative_times(found)[OTHER] == 2.5
    assert late_counts(found) == {DEFAULT.name: 0, OTHER: 0}


def test_the_page_lists_late_poses_and_times() -> None:
    found = results([row(second=0.2), row(seconds=2.0)], [row(second=0.1), row(seconds=5.0)])
    assert relative_times(found) == {DEFAULT.name: 1.0, OTHER: 2.0}
    text = page(found)
    assert f"| {DEFAULT.name} | 2 | 1 | 1 | 0 |" in text
    assert f"| {OTHER} | 2 | 2 | 0 | 0 |" in text
    (place,) = found[DEFAULT.name][NAME].late
    assert f"| {NAME} | {place[0]!r}, {place[1]!r}, {place[2]!r} |" in text
    assert chart(found) == chart(found)


def test_each_setting_changes_the_kernels(tmp_path: Path) -> None:
    originals = tmp_path / "original"
    copy_package(DEFAULT, originals)
    for i, setting in enumerate(SETTINGS):
        copy_package(setting, tmp_path / str(i))
        changed = [
            path.name
            for path in (originals / "threadstate" / "contact").glob("*.py")
            if path.read_text() != (tmp_path / str(i) / "threadstate" / "contact" / path.name).read_text()
        ]
        assert sorted(changed) == sorted({file for file, _, _ in setting.texts})
    with pytest.raises(ValueError, match="0 times"):
        copy_package(Setting("none", (("_ridge_kernel.py", "no such text", ""),)), tmp_path / "none")


def test_the_page_has_all_settings(repository_root: Path) -> None:
    text = (repository_root / "docs" / "certainty.md").read_text()
    for setting in SETTINGS:
        assert text.count(f"| {setting.name} |") == 2
