"""The study of the paper's case in a compliant hand: how it brackets a friction, and what its page says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from studies.paper_case.page import limits_picture, page, path_picture
from studies.paper_case.study import (
    CENTRES,
    NARROW,
    PHASE_DEG,
    TILT_STIFFNESSES,
    Ended,
    device,
    ended,
    limit_of,
    path_of,
)
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import Device, SettledFlag, default_device


def engaging_up_to(most: float) -> Callable[[Device, float], Ended]:
    """A run of paths that engage up to a friction."""

    def run(_held: Device, mu: float) -> Ended:
        if mu <= most:
            return Ended(mu, AssemblyOutcome.ENGAGED, (), (357.0, 0.005), 10, 90.0)
        return Ended(mu, AssemblyOutcome.UNDECIDED, (SettledFlag.FLUSH,), None, 3, 310.0)

    return run


@pytest.mark.parametrize("most", [0.0, 0.01, 0.021, 0.07, 0.3])
def test_the_critical_friction_is_bracketed(most: float) -> None:
    limit = limit_of(default_device(), engaging_up_to(most))
    last, other = limit.last_engaged, limit.first_other
    assert last is not None
    assert other is not None
    assert last.mu <= most < other.mu
    assert other.mu - last.mu <= NARROW
    assert [path.mu for path in limit.paths] == sorted({path.mu for path in limit.paths})


def test_a_device_that_always_or_never_assembles_has_one_end() -> None:
    always, never = (limit_of(default_device(), engaging_up_to(most)) for most in (1.0, -1.0))
    assert always.first_other is None
    assert always.last_engaged == always.paths[-1]
    assert never.last_engaged is None
    assert never.first_other == never.frictionless
    assert len(never.paths) == 1


def test_the_page_says_what_was_found() -> None:
    limits = {50.0: limit_of(default_device(), engaging_up_to(0.07)), 500.0: limit_of(device(), engaging_up_to(-1.0))}
    text = page([], limits, {})
    last, other = limits[50.0].last_engaged, limits[50.0].first_other
    assert last is not None
    assert other is not None
    assert f"| 50 | `engaged` | 357.00, 0.127 | {last.mu:g} | {other.mu:g} | `undecided` (`flush`) |" in text
    assert "| 500 | `undecided` (`flush`) | none | - | 0 | `undecided` (`flush`) |" in text
    assert limits_picture(limits, limits) == limits_picture(limits, limits)


@pytest.mark.slow
def test_a_path_is_told_and_drawn() -> None:
    path = path_of(device(), 0.0)
    one = ended(path)
    assert one.engages
    assert one.snap is not None
    assert PHASE_DEG < one.snap[0] < PHASE_DEG + 360.0
    assert f"Without friction it snaps at {one.snap[0]:.2f} deg" in page([path], {}, {})
    assert path_picture([path]).startswith("<?xml")


def test_the_page_has_all_devices(repository_root: Path) -> None:
    lines = (repository_root / "docs" / "paper-case.md").read_text().splitlines()
    for value in (*TILT_STIFFNESSES, *CENTRES):
        assert any(line.startswith(f"| {value:g} | `") for line in lines)
