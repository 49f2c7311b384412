from __future__ import annotations

import pytest

from threadstate.units import LengthUnit
from worker.tables import interval_end, length, phase, table

IN, MM = LengthUnit.INCH, LengthUnit.MILLIMETRE
WORDS = "stable three-point: 1 crest on surface (edge-surface); 2 positive flank on negative flank (flush)"


def _printed(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int | None) -> list[str]:
    monkeypatch.setattr("worker.tables.terminal_width", lambda: width)
    rows = table("phase", "key", "contacts", words_last=True)
    rows.add_row("0.000000", "12b904af6f", WORDS)
    rows.add_row("12.500000", "e33b6acdbe", "")
    rows.print()
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize("width", [None, 200])
def test_a_row_that_has_room_is_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int | None
) -> None:
    assert _printed(capsys, monkeypatch, width) == [
        "phase      key         contacts",
        f"0.000000   12b904af6f  {WORDS}",
        "12.500000  e33b6acdbe",
    ]


def test_words_that_have_no_room_go_below_their_row(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _printed(capsys, monkeypatch, 80) == [
        "phase      key",
        "      contacts",
        "0.000000   12b904af6f",
        "      stable three-point: 1 crest on surface (edge-surface); 2 positive flank on",
        "      negative flank (flush)",
        "12.500000  e33b6acdbe",
    ]


@pytest.mark.parametrize("words_last", [False, True])
@pytest.mark.parametrize("width", [10, 30])
def test_a_number_is_never_broken(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int, words_last: bool
) -> None:
    monkeypatch.setattr("worker.tables.terminal_width", lambda: width)
    rows = table("from", "to", "height", "words", words_last=words_last)
    rows.add_row("357.380891", "-> 35.060199", "0.007463", "edge-edge")
    rows.print()
    row, *below = capsys.readouterr().out.splitlines()[2 if words_last else 1 :]
    assert row.split("  ")[:3] == ["357.380891", "-> 35.060199", "0.007463"]
    assert below == (["      edge-edge"] if words_last else [])


@pytest.mark.parametrize(
    ("value", "unit", "shown"),
    [
        (None, IN, "-"),
        (0.0, IN, "0"),
        (2e-9, IN, "0"),
        (-4.9e-7, IN, "0"),
        (5.1e-7, IN, "0.000001"),
        (-0.045168, IN, "-0.045168"),
        (4.9e-6, MM, "0"),
        (0.18956927, MM, "0.18957"),
    ],
)
def test_a_length_has_the_digits_that_fit_its_unit(value: float | None, unit: LengthUnit, shown: str) -> None:
    assert length(value, unit) == shown


def test_a_change_of_length_has_its_sign_unless_it_is_none() -> None:
    assert [length(value, IN, signed=True) for value in (0.001, -0.001, 1e-9)] == ["+0.001000", "-0.001000", "0"]


@pytest.mark.parametrize(
    ("start", "end", "shown"),
    [
        (10.0, 20.0, "20.000000"),
        (357.38, 395.06, "-> 35.060000"),
        (350.0, 360.0, "-> 0.000000"),
        (0.0, 360.0, "-> 0.000000"),
        (350.0, 359.9999999, "-> 0.000000"),
        (357.9, 717.9, "-> 357.900000"),
    ],
)
def test_an_end_past_360_is_marked_and_in_the_turn(start: float, end: float, shown: str) -> None:
    assert interval_end(start, end) == shown


@pytest.mark.parametrize(
    ("value", "shown"), [(None, "-"), (-0.0, "0.000000"), (364.0, "4.000000"), (359.9999999, "0.000000")]
)
def test_a_phase_is_in_the_turn(value: float | None, shown: str) -> None:
    assert phase(value) == shown
