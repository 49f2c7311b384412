"""Samples of approaches: their moments, and that a longer run only adds some."""

from __future__ import annotations

import statistics

import pytest
from scipy.stats import qmc, truncnorm

from threadstate.chances.sampling import BASES, Approach, Uncertainty, approach, radical_inverse
from threadstate.errors import InvalidValueError

UNCERTAINTY = Uncertainty((1.0, -2.0), 1.5, (0.05, 0.2))
COUNT = 2000


def sampled(uncertainty: Uncertainty, count: int) -> list[Approach]:
    """The first samples."""
    return [approach(uncertainty, index) for index in range(count)]


def test_points_are_those_of_halton_without_the_first() -> None:
    theirs = qmc.Halton(d=len(BASES), scramble=False).random(200)[1:]
    ours = [[radical_inverse(number, base) for base in BASES] for number in range(1, 200)]
    assert ours == pytest.approx(theirs, abs=1e-12)


def test_moments_are_those_asked_for() -> None:
    found = sampled(UNCERTAINTY, COUNT)
    rolls, pitches = [one.roll_deg for one in found], [one.pitch_deg for one in found]
    assert statistics.fmean(rolls) == pytest.approx(1.0, abs=0.01)
    assert statistics.fmean(pitches) == pytest.approx(-2.0, abs=0.01)
    assert statistics.stdev(rolls) == pytest.approx(1.5, rel=0.01)
    assert statistics.stdev(pitches) == pytest.approx(1.5, rel=0.01)
    assert statistics.correlation(rolls, pitches) == pytest.approx(0.0, abs=0.01)
    assert statistics.fmean(one.phase_deg for one in found) == pytest.approx(180.0, abs=1.0)
    assert statistics.fmean(one.mu for one in found) == pytest.approx(0.125, abs=5e-4)
    assert all(0.0 <= one.phase_deg < 360.0 and 0.05 <= one.mu <= 0.2 for one in found)


def test_the_same_input_gives_the_same_bits_and_more_samples_keep_the_first() -> None:
    assert sampled(UNCERTAINTY, 100)[:40] == sampled(UNCERTAINTY, 40)
    assert approach(UNCERTAINTY, 7) == approach(Uncertainty((1.0, -2.0), 1.5, (0.05, 0.2)), 7)
    assert approach(UNCERTAINTY, 7) != approach(UNCERTAINTY, 8)


def test_the_normal_distribution_is_cut_and_not_piled_up() -> None:
    found = [one.roll_deg for one in sampled(Uncertainty((9.0, 0.0), 3.0, (0.0, 0.0)), COUNT)]
    cut = truncnorm((-10.0 - 9.0) / 3.0, (10.0 - 9.0) / 3.0, loc=9.0, scale=3.0)
    assert max(found) < 10.0
    assert statistics.fmean(found) == pytest.approx(cut.mean(), abs=0.02)
    assert statistics.stdev(found) == pytest.approx(cut.std(), rel=0.02)


def test_a_mean_at_the_cut_and_a_tiny_deviation_stay_within() -> None:
    found = sampled(Uncertainty((10.0, -10.0), 1e-9, (0.0, 0.0)), 50)
    assert {(one.roll_deg, one.pitch_deg) for one in found} == {(10.0, -10.0)}


def test_without_deviation_only_the_phase_varies() -> None:
    found = sampled(Uncertainty((0.0, -2.0), 0.0, (0.1, 0.1)), 20)
    assert {(one.roll_deg, one.pitch_deg, one.mu) for one in found} == {(0.0, -2.0, 0.1)}
    assert len({one.phase_deg for one in found}) == 20


def test_a_sample_can_be_written_down() -> None:
    one = approach(UNCERTAINTY, 12)
    numbers = (one.roll_deg, one.pitch_deg, one.phase_deg, one.mu)
    assert [float(f"{number:.6f}") for number in numbers] == list(numbers)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (((11.0, 0.0), 1.0, (0.0, 0.1)), "tilt_mean is 11.0; valid: -10 to 10 deg"),
        (((0.0, float("nan")), 1.0, (0.0, 0.1)), "tilt_mean is nan"),
        (((0.0, 0.0), -1.0, (0.0, 0.1)), "tilt_sd is -1.0; valid: 0 to 10 deg"),
        (((0.0, 0.0), 10.5, (0.0, 0.1)), "tilt_sd is 10.5; valid: 0 to 10 deg"),
        (((0.0, 0.0), 1.0, (0.0, 1.1)), "mu is 1.1; valid: 0 to 1"),
        (((0.0, 0.0), 1.0, (-0.1, 0.1)), "mu is -0.1; valid: 0 to 1"),
        (((0.0, 0.0), 1.0, (0.2, 0.1)), "mu is '0.2:0.1'; valid: the lower friction first"),
    ],
)
def test_what_is_not_valid_is_named(given: tuple[tuple[float, float], float, tuple[float, float]], words: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        Uncertainty(*given)
    assert words in str(caught.value)
