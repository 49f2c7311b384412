"""The class at, below and above each threshold: method, section 5."""

from __future__ import annotations

import math

import pytest

from threadstate.state.classify import Classification, classify
from threadstate.state.model import StateClass

UNSTABLE, QUASI, STABLE = (
    StateClass.UNSTABLE_TWO_POINT,
    StateClass.QUASI_STABLE_TWO_POINT,
    StateClass.STABLE_THREE_POINT,
)
TOLERANCE, THRESHOLD = 1e-9, 0.0125


def classified(
    *, drop: float | None, embedment: float | None, pivot: float | None, flush: bool = False, third: bool = True
) -> Classification:
    return classify(
        flush=flush,
        third=third,
        drop=drop,
        embedment=embedment,
        pivot_offset=pivot,
        pivot_threshold=THRESHOLD,
        embedment_tolerance=TOLERANCE,
    )


ABOVE, BELOW = math.nextafter(THRESHOLD, 1.0), math.nextafter(THRESHOLD, 0.0)


@pytest.mark.parametrize(
    ("drop", "embedment", "pivot", "expected"),
    [
        # drop <= embedment, embedment above tolerance
        (1e-3, 1e-3, 0.05, UNSTABLE),
        (math.nextafter(1e-3, 0.0), 1e-3, 0.05, UNSTABLE),
        (math.nextafter(1e-3, 1.0), 1e-3, 0.05, STABLE),
        # embedment at its tolerance counts as none
        (0.0, TOLERANCE, 0.05, STABLE),
        (0.0, math.nextafter(TOLERANCE, 1.0), 0.05, UNSTABLE),
        (0.0, 0.0, 0.05, STABLE),
        # the pivot's threshold belongs to quasi-stable
        (1e-3, 0.0, THRESHOLD, QUASI),
        (1e-3, 0.0, BELOW, QUASI),
        (1e-3, 0.0, ABOVE, STABLE),
        (1e-3, 0.0, 0.0, QUASI),
        # unstable comes before quasi-stable
        (1e-4, 1e-3, 0.0, UNSTABLE),
    ],
)
def test_boundaries(drop: float, embedment: float, pivot: float, expected: StateClass) -> None:
    assert classified(drop=drop, embedment=embedment, pivot=pivot).state_class is expected


def test_without_a_third_contact_a_state_is_unstable() -> None:
    assert classified(drop=None, embedment=None, pivot=0.05, third=False).state_class is UNSTABLE
    assert classified(drop=None, embedment=None, pivot=None, third=False).state_class is UNSTABLE


def test_flush_is_stable_whatever_the_numbers() -> None:
    assert classified(drop=None, embedment=None, pivot=None, third=False, flush=True).state_class is STABLE
    assert classified(drop=1e-4, embedment=1e-3, pivot=0.0, flush=True).state_class is STABLE


def test_margins_are_positive_on_the_stable_side() -> None:
    classification = classified(drop=3e-3, embedment=1e-3, pivot=0.05)
    assert classification.drop_margin == pytest.approx(2e-3)
    assert classification.embedment_margin == pytest.approx(TOLERANCE - 1e-3)
    assert classification.pivot_margin == pytest.approx(0.05 - THRESHOLD)
    assert classified(drop=None, embedment=None, pivot=None, third=False) == Classification(UNSTABLE, None, None, None)
