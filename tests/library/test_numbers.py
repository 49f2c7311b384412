from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from threadstate.numbers import number_text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_reads_back_the_same(value: float) -> None:
    assert float(number_text(value)) == value


@pytest.mark.parametrize(
    ("value", "text"),
    [(185.0, "185"), (4, "4"), (-3.0, "-3"), (-0.0, "0"), (123.0125, "123.0125"), (1e-7, "1e-07"), (0.1, "0.1")],
)
def test_a_number_is_written_without_what_says_nothing(value: float, text: str) -> None:
    assert number_text(value) == text
    assert number_text(np.float64(value)) == text


def test_no_number_is_cut_to_six_digits(repository_root: Path) -> None:
    """The format ``g`` does so without a word; ``number_text`` does not."""
    found = [
        f"{path.relative_to(repository_root)}:{number}"
        for room in ("threadstate", "worker", "service", "migrations")
        for path in sorted((repository_root / room).rglob("*.py"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if re.search(r":g\}|%g", line)
    ]
    assert found == []
