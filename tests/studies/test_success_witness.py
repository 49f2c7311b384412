"""The study of success maps beside the witness: one that does not agree is asked once more, with half its step."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from oracle.outcomes import STEP_DEG, End
from studies.success_witness import study
from studies.success_witness.page import page
from studies.success_witness.study import Compared, done
from threadstate.device.assembly_model import AssemblyOutcome

NAN = math.nan


def end(outcome: str) -> End:
    """An end of a path by the witness."""
    return End(outcome, NAN, NAN, NAN, 0.2, NAN, 1.0, 3, 0)


def solve(monkeypatch: pytest.MonkeyPatch, *, is_alike: bool) -> None:
    """The solver says that each path engages, and whether it does with half its step."""
    paths = SimpleNamespace(
        cell=lambda *_: SimpleNamespace(outcome=AssemblyOutcome.ENGAGED), ends_alike=lambda _: is_alike
    )
    monkeypatch.setattr(study, "OrientationPaths", lambda *_, **__: paths)


@pytest.mark.parametrize(
    ("outcomes", "halved", "steps"),
    [
        (("engaged",), None, [STEP_DEG]),
        (("undecided", "engaged"), "engaged", [STEP_DEG, 0.5 * STEP_DEG]),
        (("no_snap", "engaged"), "engaged", [STEP_DEG, 0.5 * STEP_DEG]),
        (("no_snap", "no_snap"), "no_snap", [STEP_DEG, 0.5 * STEP_DEG]),
    ],
)
def test_a_witness_that_does_not_agree_is_asked_with_half_its_step(
    monkeypatch: pytest.MonkeyPatch, outcomes: tuple[str, ...], halved: str | None, steps: list[float]
) -> None:
    asked: list[float] = []
    answers = iter(outcomes)

    def followed(*_: Any, step_deg: float = STEP_DEG, **__: Any) -> tuple[End, list[Any]]:
        asked.append(step_deg)
        return end(next(answers)), []

    solve(monkeypatch, is_alike=True)
    monkeypatch.setattr(study, "followed_to_end", followed)
    found = done(0)
    assert (found.witness.outcome, found.halved, asked) == (outcomes[0], halved, steps)
    assert found.agrees_halved == (halved == "engaged")


def test_a_path_that_ends_otherwise_with_half_the_solvers_step_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    solve(monkeypatch, is_alike=False)
    monkeypatch.setattr(study, "followed_to_end", lambda *_, **__: (end("engaged"), []))
    found = done(0)
    assert (found.solver, found.is_decided, found.halved) == ("undecided", False, None)


def test_the_page_counts_those_that_agree_with_half_the_step() -> None:
    strategy, pose_deg, mu = study.cell(0)
    cells = [
        Compared(strategy, pose_deg, mu, "engaged", end("engaged"), 1.0),
        Compared(strategy, pose_deg, mu, "engaged", end("no_snap"), 1.0, "engaged"),
        Compared(strategy, pose_deg, mu, "engaged", end("undecided"), 1.0, "no_snap"),
        Compared(strategy, pose_deg, mu, "engaged", end("undecided"), 1.0, "undecided"),
        Compared(strategy, pose_deg, mu, "undecided", end("engaged"), 1.0),
    ]
    text = page(cells)
    assert "Of the first 5 cells 2 have an outcome by both, of which\n1 agree." in text
    assert "0.25 deg: 2 have an outcome by both then,\nof which 1 agree." in text
    assert text.count("| engaged | no_snap | engaged |") == 1
