"""How a device approaches: distributions of tilt, phase and friction, and their samples by a Halton sequence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text

LARGEST_TILT_DEG = 10.0
LARGEST_SD_DEG = 10.0
LARGEST_FRICTION = 1.0
BASES = (2, 3, 5, 7)
"""Of the Halton sequence, for roll, pitch, phase and friction."""
DECIMALS = 6
"""Of a sample's angles in degrees and of its friction: a sample can be written down and repeated."""


@dataclass(frozen=True)
class Uncertainty:
    """How an approach is distributed.

    Roll and pitch are independent and normal, with the means ``tilt_mean_deg`` and the standard deviation
    ``tilt_sd_deg``, given that neither is beyond 10 deg. The phase is uniform over the turn, the friction from the
    first to the second number of ``mu``.

    Raises:
        InvalidValueError: a mean is beyond 10 deg, the standard deviation is not 0 to 10 deg, a friction is not 0 to 1
            or the first one is the larger.
    """

    tilt_mean_deg: tuple[float, float]
    tilt_sd_deg: float
    mu: tuple[float, float]

    def __post_init__(self) -> None:
        for mean in self.tilt_mean_deg:
            if not abs(mean) <= LARGEST_TILT_DEG:
                raise InvalidValueError("tilt_mean", mean, "-10 to 10 deg")
        if not 0.0 <= self.tilt_sd_deg <= LARGEST_SD_DEG:
            raise InvalidValueError("tilt_sd", self.tilt_sd_deg, "0 to 10 deg")
        for mu in self.mu:
            if not 0.0 <= mu <= LARGEST_FRICTION:
                raise InvalidValueError("mu", mu, "0 to 1")
        if self.mu[0] > self.mu[1]:
            given = ":".join(map(number_text, self.mu))
            raise InvalidValueError("mu", given, "the lower friction first")


@dataclass(frozen=True, slots=True)
class Approach:
    """A sample: the commanded pose, in degrees, and the friction; ``index`` is its number, from 0."""

    index: int
    roll_deg: float
    pitch_deg: float
    phase_deg: float
    mu: float


def approach(uncertainty: Uncertainty, index: int) -> Approach:
    """The sample with this number. It does not depend on how many there are.

    The first point of the sequence, zero, is left out: the normal distribution has no such quantile.
    """
    roll, pitch, phase, mu = (radical_inverse(index + 1, base) for base in BASES)
    low, high = uncertainty.mu
    mean_roll, mean_pitch = uncertainty.tilt_mean_deg
    return Approach(
        index,
        _cut_normal(roll, mean_roll, uncertainty.tilt_sd_deg),
        _cut_normal(pitch, mean_pitch, uncertainty.tilt_sd_deg),
        _rounded(360.0 * phase),
        _rounded(low + (high - low) * mu),
    )


def radical_inverse(number: int, base: int) -> float:
    """The digits of a number mirrored at the point (Halton 1960): from 0 to 1, without the latter."""
    mirrored, scale = 0, 1
    while number:
        number, digit = divmod(number, base)
        mirrored = mirrored * base + digit
        scale *= base
    return mirrored / scale


def _cut_normal(fraction: float, mean: float, sd: float) -> float:
    """The quantile of a normal distribution given that it is within 10 deg."""
    if sd == 0.0:
        return _rounded(mean)
    normal = NormalDist(mean, sd)
    low, high = normal.cdf(-LARGEST_TILT_DEG), normal.cdf(LARGEST_TILT_DEG)
    value = normal.inv_cdf(low + (high - low) * fraction)
    return _rounded(math.copysign(min(abs(value), LARGEST_TILT_DEG), value))


def _rounded(value: float) -> float:
    return round(value, DECIMALS) + 0.0
