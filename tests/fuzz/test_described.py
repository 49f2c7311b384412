"""A small run of what ``make fuzz`` does at length."""

from __future__ import annotations

from pathlib import Path

import pytest

from scripts.fuzz import run

pytestmark = pytest.mark.sqlite_alone


def test_every_answer_is_as_described(tmp_path: Path) -> None:
    tally = run(tmp_path, examples=1, seed=20060128, longest_s=3600)
    assert tally.wrong == []
    assert len(tally.cases) >= 27, "every operation is asked"
    assert tally.total > 500
    assert {200, 202, 400, 404, 405} <= set(tally.statuses)
