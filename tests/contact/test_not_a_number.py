"""A bound that is NaN excludes nothing."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from tests.contact.edges import new_edge, new_kept
from tests.contact.samples import Floats
from threadstate.contact import _box_kernel as box
from threadstate.contact import _branchless_kernel as branchless
from threadstate.contact import _rectangle_kernel as rectangle
from threadstate.contact._beside_kernel import K_TANGENT, keep
from threadstate.contact._bound_kernel import BOUNDS_SIZE, set_bounds
from threadstate.contact._edge_kernel import Box
from threadstate.contact._edge_search_kernel import no_onset_from_contact
from threadstate.contact._entry_kernel import half_space
from threadstate.contact._geometry_kernel import MOTION_SIZE, PATH_SIZE
from threadstate.contact._lift_kernel import inside_until
from threadstate.contact._range_kernel import Ranges, product_range
from threadstate.contact._stage_kernel import CONTACT_SIZE, rotation, set_motions
from threadstate.contact._surface_kernel import meets_surface_first
from threadstate.thread import _profile_kernel as pk
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
P = PAIR.thread_pitch


def descent(pose_deg: tuple[float, float, float], height: float) -> tuple[Floats, Floats]:
    """The motions of the bolt's edge and of the nut's, straight down from a height."""
    pose = np.zeros(12)
    roll, pitch, phase = map(math.radians, pose_deg)
    rotation(roll, pitch, phase, pose)
    pose[11] = height
    down = np.array([0.0, 0.0, -1.0])
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    set_motions(pose, False, False, down, down, bolt_motion, nut_motion)
    return bolt_motion, nut_motion


@pytest.mark.parametrize("known", [-1.0, 0.0, 2.0, math.inf])
def test_the_larger_or_smaller_of_a_number_and_nan(known: float) -> None:
    choose: Callable[[float, float], float]
    for choose in (branchless.larger_or_nan, branchless.smaller_or_nan):
        assert math.isnan(choose(math.nan, known))
        assert math.isnan(choose(known, math.nan))
    for choose in (branchless.larger, branchless.smaller):
        assert choose(math.nan, known) == known
        assert math.isnan(choose(known, math.nan))


@pytest.mark.parametrize("unknown", range(4))
def test_a_product_of_an_unknown_factor_is_unknown(unknown: int) -> None:
    factors = [-1.0, 2.0, -3.0, 4.0]
    assert product_range(*factors) == (-6.0, 8.0)
    factors[unknown] = math.nan
    assert all(map(math.isnan, product_range(*factors)))


def test_within_an_unknown_reach_a_profile_has_any_slope_and_no_bound() -> None:
    numbers = branchless.profile_numbers(PAIR.bolt.packed)
    radius, slope, u, rises = branchless.radius_and_slope(0.0, numbers)
    course = branchless.course_over(radius, slope, u, math.nan, rises, numbers)
    assert course == (-PAIR.bolt.packed[pk.STEEPEST] - slope, 0.0, -math.inf, math.inf)


def test_nan_has_no_known_second_derivative() -> None:
    numbers = branchless.profile_numbers(PAIR.bolt.packed)
    for u, reach in ((math.nan, 1e-4), (0.0, math.nan)):
        assert all(map(math.isnan, branchless.second_derivative_range(u, reach, True, numbers)))
        assert pk.second_derivative_range(u, reach, PAIR.bolt.packed) == (-math.inf, math.inf)
    assert all(map(math.isnan, branchless.radius_and_slope(math.nan, numbers)[:3]))


def test_no_box_is_excluded_by_nan() -> None:
    """One number of a box becomes NaN: it stays excluded only if it is excluded for every value of that number."""
    rng = np.random.default_rng(71)
    excluded = 0
    signed = [Ranges._fields.index(name) for name in ("value", "by_theta", "by_tau", "tt_low", "tt_high", "tv")]
    unbounded = [Ranges._fields.index(name) for name in ("theta_low", "theta_high", "tau_change", "below", "above")]
    of_phi = len(Ranges._fields)
    of_g = [of_phi + i for i in range(of_phi) if i not in unbounded]
    known = [*range(of_phi), *of_g]
    for _ in range(4000):
        numbers = rng.normal(0.0, 1.0, 2 * of_phi)
        numbers[:of_phi] *= 10.0 ** rng.uniform(-4, 0)
        for first in (0, of_phi):
            numbers[first + 3], numbers[first + 4] = sorted(numbers[first + 3 : first + 5])
            for i in range(of_phi):
                if i not in signed:
                    numbers[first + i] = abs(numbers[first + i])
        slopes = [Ranges._fields.index(name) for name in ("theta_low", "theta_high")]
        numbers[slopes] = numbers[1] + numbers[slopes] * (-1.0, 1.0)
        numbers[[of_phi + i for i in unbounded]] = math.inf
        numbers[of_phi + slopes[0]] = -math.inf
        a, b = 10.0 ** rng.uniform(-6, -0.5, 2)

        def box_class(values: Floats, a: float = a, b: float = b) -> float:
            phi, g = (Ranges(*values[first : first + of_phi].tolist()) for first in (0, of_phi))
            return float(box.classify_box(a, b, phi, g, -1.0, P)[0])

        for i in known:
            unknown = numbers.copy()
            unknown[i] = math.nan
            if box_class(unknown) <= box.EXCLUDED:
                excluded += 1
                for size in (0.0, 1e-3, 1.0, 1e3, 1e6):
                    for sign in (-1.0, 1.0):
                        unknown[i] = sign * size
                        assert box_class(unknown) <= box.EXCLUDED, (i, numbers.tolist(), a, b)
    assert excluded > 1000


@pytest.mark.parametrize("is_turn", [False, True])
def test_a_half_space_of_unknown_place_excludes_nothing(is_turn: bool) -> None:
    for unknown in range(3):
        coefficients = [-1.0, -1.0, -1.0]
        coefficients[unknown] = math.nan
        a, b, c = coefficients
        assert half_space(a, b, c, is_turn) == (0.0, math.inf)


def test_a_rectangle_of_unknown_place_stays_undecided() -> None:
    motion, _ = descent((2.0, -3.0, 100.0), -0.02)
    bounds, path = np.empty(BOUNDS_SIZE), np.empty(PATH_SIZE)
    bolt, nut = PAIR.bolt.packed, PAIR.nut.packed
    small = np.array([1.0, 0.01, 0.01, 1e-4])
    for unknown in (2, 9, 11):
        unknown_motion = motion.copy()
        unknown_motion[unknown] = math.nan
        set_bounds(unknown_motion, bolt, nut, bounds)
        assert (
            rectangle.classify_rectangle(small, 0.01, unknown_motion, bolt, nut, bounds, path)
            == rectangle.RECT_UNDECIDED
        )


@pytest.mark.parametrize("on_plane", [True, False])
def test_an_unknown_way_from_a_contact_excludes_nothing(on_plane: bool) -> None:
    motion, _ = descent((2.0, -3.0, 100.0), -0.02)
    motion[9] = math.nan
    kept = new_kept(1)
    keep(1.0, on_plane, True, kept)
    kept[0, K_TANGENT] = 1.0
    edge = new_edge(motion, PAIR.bolt.packed, PAIR.nut.packed, kept)
    no_onset = no_onset_from_contact(Box(1.005, 1e-4, 0.0, 1e-6), (1.0, 2.0), edge, np.zeros(box.BOXES_SIZE))
    assert no_onset == (False, False)


def test_a_bolt_whose_lowest_point_is_unknown_does_not_meet_the_surface_first() -> None:
    pose = np.zeros(12)
    rotation(0.03, -0.02, 1.0, pose)
    pose[0] = math.nan
    assert not meets_surface_first(pose, PAIR.bolt.packed, PAIR.nut.packed, np.empty(CONTACT_SIZE))


def test_a_witness_is_followed_no_farther_than_it_is_known_to_be_inside() -> None:
    path = np.zeros(PATH_SIZE)
    path[0], path[2], path[8], path[9] = math.nan, -0.01, 1.0, 1.0
    bounds = np.empty(BOUNDS_SIZE)
    set_bounds(descent((2.0, -3.0, 100.0), 0.0)[0], PAIR.bolt.packed, PAIR.nut.packed, bounds)
    assert inside_until(path, 0.0, 0.005, 1.0, PAIR.nut.packed, 1.0, bounds) == 0.0
