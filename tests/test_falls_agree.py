"""Whatever names the fall of an orientation names the figure of docs/windows.md, which has all 81 of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from studies.paper import statements
from studies.paper.claim import Statement
from tests.falls_page import ShownFalls, Tilt, falls_shown, text_of

Falls = Mapping[Tilt, ShownFalls]


@pytest.fixture(scope="module")
def falls(repository_root: Path) -> Falls:
    """The rows of all orientations."""
    return falls_shown(repository_root)


def measured(repository_root: Path, statement: str) -> str:
    """What docs/paper-claims.md says was measured on a statement."""
    lines = (repository_root / "docs" / "paper-claims.md").read_text().splitlines()
    (found,) = (cells[3] for line in lines if len(cells := line[2:-2].split(" | ")) == 5 and cells[1] == statement)
    return found


def largest(falls: Falls) -> str:
    return max((row.fall for row in falls.values() if row.snaps), key=float)


def test_the_page_counts_its_own_rows(repository_root: Path, falls: Falls) -> None:
    snaps = [row for row in falls.values() if row.snaps]
    smooth = [row for row in snaps if not row.jump_at]
    partly = [row for row in snaps if row.jump_at and float(row.jump) < 0.5 * float(row.fall)]
    said = " ".join(text_of(repository_root).split())
    assert f"{len(snaps)} of the {len(falls)} orientations snap, by up to {largest(falls)} in." in said
    assert f"In {len(smooth)} of these snaps nothing jumps, in {len(partly)} more the jump is less than half" in said


def test_rows_follow_the_definitions(falls: Falls) -> None:
    for row in falls.values():
        assert row.snaps == (float(row.steepest) > 0.0025)
        assert (row.snap_from == "") == (row.snap_to == "") == (row.jump == "") == (not row.snaps)
        if row.snaps:
            assert float(row.jump) <= float(row.fall)
            assert float(row.steepest) <= float(row.fall)
            assert float(row.snap_from) < float(row.snap_to)


def test_the_study_of_the_paper_counts_the_same_snaps(repository_root: Path, falls: Falls) -> None:
    tilted = {tilt: row for tilt, row in falls.items() if tilt != (0, 0)}
    without = [tilt for tilt, row in tilted.items() if not row.snaps]
    assert measured(repository_root, statements.SNAP.text) == (
        f"{len(tilted) - len(without)} of {len(tilted)} orientations snap, by up to {largest(tilted)} in; of the "
        f"{len(without)} that do not, {sum(pitch > 0 for _, pitch in without)} have a positive pitch"
    )


@pytest.mark.parametrize(
    ("statement", "tilt"),
    [(statements.SUBTLE, lambda size: (-size, 0)), (statements.MINIMAL_DROP, lambda size: (0, size))],
)
def test_the_study_of_the_paper_compares_the_same_steepest_falls(
    repository_root: Path, falls: Falls, statement: Statement, tilt: Callable[[int], Tilt]
) -> None:
    said = [f"{size} deg: {falls[tilt(size)].steepest} in, case 1 {falls[size, 0].steepest} in" for size in range(1, 5)]
    assert measured(repository_root, statement.text) == "; ".join(said)


def test_the_decision_names_the_same_figures(repository_root: Path, falls: Falls) -> None:
    said = " ".join((repository_root / "docs" / "decisions" / "0017-falls.md").read_text().split())
    gliding, jumping = falls[-4, -4], falls[0, -4]
    assert f"at roll -4, pitch -4 the bolt goes down {float(gliding.steepest):.4f} in within 3 deg" in said
    assert not gliding.jump_at
    assert f"at roll 0, pitch -4 it goes down {float(jumping.fall):.4f} in" in said
    assert f"of which {float(jumping.jump):.4f} in at one phase" in said
    counted = re.search(
        r"81 orientations: (\d+) snap .*?, by up to (\S+) in; (\d+) of those have no jump, (\d+) more", said
    )
    assert counted is not None
    snaps = [row for row in falls.values() if row.snaps]
    smooth = sum(not row.jump_at for row in snaps)
    partly = sum(float(row.jump) < 0.5 * float(row.fall) for row in snaps) - smooth
    assert counted.groups() == (str(len(snaps)), f"{float(largest(falls)):.4f}", str(smooth), str(partly))


def test_the_examples_shown_print_the_same_figures(repository_root: Path, falls: Falls) -> None:
    page = (repository_root / "docs" / "examples.md").read_text()
    asked = re.findall(
        r"^\$ python examples/feel_before_the_window\.py (-?\d) (-?\d)\n(?:.*\n)*?(?:no )?snap: (.*)$", page, re.M
    )
    assert [(roll, pitch) for roll, pitch, _ in asked] == [("4", "0"), ("0", "-4")]
    for roll, pitch, said in asked:
        row = falls[int(roll), int(pitch)]
        if row.snaps:
            start, end, jump_at = (f"{float(phase):.3f}" for phase in (row.snap_from, row.snap_to, row.jump_at))
            happens = f"from phase {start} to {end} deg, {row.jump} of it at once at {jump_at} deg"
            assert said == f"falls by {row.fall} {happens}"
        else:
            assert (
                said
                == f"falls by {row.steepest} within 3 deg at most, from phase {float(row.steepest_from):.3f} deg on"
            )


def test_the_table_of_the_examples_has_the_same_figures(repository_root: Path, falls: Falls) -> None:
    page = (repository_root / "docs" / "examples.md").read_text()
    (shown,) = re.findall(r"^\$ python examples/windows_table\.py mm\n(.*?)^```", page, re.M | re.S)
    lines = [line.split() for line in shown.splitlines() if re.match(r" +-?\d ", line)]
    assert any("no" in cells for cells in lines)
    for roll, pitch, *cells in lines:
        row = falls[int(roll), int(pitch)]
        assert row.snaps == (cells[:2] != ["no", "snap"])
        # Lengths of the rows are rounded to 1e-6 in.
        if row.snaps:
            wanted = [25.4 * float(length) for length in (row.fall, row.jump, row.steepest)]
            assert [float(cell) for cell in cells[2:5]] == pytest.approx(wanted, abs=2e-5)
        else:
            assert float(cells[2]) == pytest.approx(25.4 * float(row.steepest), abs=2e-5)


def test_the_tutorial_shows_the_same_figures(repository_root: Path, falls: Falls) -> None:
    text = (repository_root / "docs" / "tutorial.md").read_text()
    answers = re.findall(r"^\$ threadstate windows --roll (-?\d) --pitch (-?\d)\nroll .*\n(.*)$", text, re.MULTILINE)
    assert len(answers) == 2
    for roll, pitch, line in answers:
        row = falls[int(roll), int(pitch)]
        cells = line.split()
        shown = [row.snap_from, row.snap_to, row.fall, row.jump, row.jump_at] if row.snaps else ["-"] * 5
        assert cells == [roll, pitch, *shown, row.steepest, row.steepest_from]
    jumping = falls[0, -4]
    assert f"That snap is felt: {float(jumping.fall):.4f} in" in text
    assert f"{float(jumping.jump):.4f} in of it at one phase" in text
    assert f"the bolt goes down by {float(falls[4, 0].steepest):.4f} in at most" in text
    within, compared = re.findall(r"^snap falls \(in\) +(\S+) +(\S+)$", text, re.MULTILINE)
    assert compared[0] == jumping.fall
    assert float(within[0]) < float(within[1])
