from __future__ import annotations

import pytest

from threadstate.mesh.steps import Find, approach, decades, march_and_halve, regress


def between(low: float, high: float) -> Find[str]:
    return lambda place: "found" if low <= place < high else None


def test_decades_end_with_the_final_step() -> None:
    assert decades(0.01, 1e-6) == pytest.approx([1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
    assert decades(0.01, 3e-5) == pytest.approx([1e-2, 1e-3, 1e-4, 3e-5])
    assert decades(0.01, 0.01) == [0.01]


def test_regressing_steps_end_within_the_last_step() -> None:
    reached = regress(between(0.12345, 9.0), decades(0.01, 1e-5), 1.0)
    assert reached is not None
    assert 0.0 <= reached.place - 0.12345 <= 1e-5
    assert regress(between(2.0, 3.0), decades(0.01, 1e-5), 1.0) is None


def test_regressing_steps_tunnel_through_what_is_thinner() -> None:
    reached = regress(between(0.012, 0.019), [0.01], 1.0)
    assert reached is None
    wall = approach(between(0.012, 0.019), lambda place: max(0.0, 0.012 - place), 1e-6, 1.0, 100)
    assert wall is not None
    assert wall.place == pytest.approx(0.012, abs=1e-6)


def test_halving_ends_within_the_final_step() -> None:
    reached = march_and_halve(between(0.12345, 9.0), 1e-3, 1e-7, 1.0)
    assert reached is not None
    assert 0.0 <= reached.place - 0.12345 <= 1e-7
    assert march_and_halve(between(2.0, 3.0), 1e-3, 1e-7, 1.0) is None


def test_an_approach_ends_at_its_limit_or_gives_up() -> None:
    assert approach(between(5.0, 6.0), lambda place: 5.0 - place, 1e-3, 1.0, 100) is None
    with pytest.raises(TimeoutError):
        approach(between(5.0, 6.0), lambda _: 0.0, 1e-3, 1.0, 100)
