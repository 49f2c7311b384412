from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from threadstate.numbers import integer, number, number_text


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


ODD = [
    "",
    " 1",
    "1 ",
    "1_0",
    "nan",
    "inf",
    "-Infinity",
    "٣",
    "1\N{NO-BREAK SPACE}",
    "0x10",
    "1e",
    ".",
    "--1",
    "1,5",
    "1\n",
    "1e999",
]


@pytest.mark.parametrize("text", ODD)
def test_what_python_reads_beyond_numbers_is_refused(text: str) -> None:
    for read in (number, integer):
        with pytest.raises(ValueError, match=re.escape(f"{text!r} is not a")):
            read(text)


@pytest.mark.parametrize(
    ("text", "value"), [("4", 4.0), ("-0.5", -0.5), ("+4.", 4.0), (".5", 0.5), ("1e-07", 1e-7), ("2E+3", 2000.0)]
)
def test_a_decimal_number_is_read(text: str, value: float) -> None:
    assert number(text) == value


def test_a_whole_number_is_read() -> None:
    assert [integer(text) for text in ("0", "007", "-12", "+3")] == [0, 7, -12, 3]
    for text in ("1.0", "1e2", "9" * 19):
        with pytest.raises(ValueError, match="is not a whole number"):
            integer(text)
