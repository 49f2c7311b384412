"""The coordinates of a held bolt and the derivatives of its overlaps, beside differences and matrix exponentials."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    EDGE_SURFACE,
    EDGE_THREAD,
    THREAD_EDGE,
    THREAD_THREAD,
)
from threadstate.device import _chart_kernel as ck
from threadstate.device import _gap_kernel as gk
from threadstate.device import _places_kernel as pl
from threadstate.device.command import commanded_rotation
from threadstate.device.model import About
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

CENTRE = 0.1


def cross(e: Floats) -> Floats:
    """The matrix of the cross product by a vector."""
    return np.array([[0.0, -e[2], e[1]], [e[2], 0.0, -e[0]], [-e[1], e[0], 0.0]])


def device(command: Floats) -> Floats:
    """The numbers of a device whose centre is off the base."""
    numbers = np.zeros(ck.DEVICE_SIZE)
    numbers[ck.D_CENTRE] = CENTRE
    numbers[ck.D_ROTATION : ck.D_ROTATION + 9] = command
    numbers[ck.D_SCALE] = 0.125
    numbers[ck.D_FINE] = pl.FINE
    return numbers


class Search:
    """The places of overlap of a pair held at a command."""

    def __init__(self, pair: Pair, command: Floats) -> None:
        self._pair = pair
        self.device = device(command)
        self._threads = pl.new_threads(pair.bolt.packed)
        self._work = np.zeros(pl.PLACES_WORK)

    def places(self, q: Floats, reach: float) -> Floats:
        """The places above ``-reach``."""
        place = np.zeros(ck.PLACE_SIZE)
        places = np.zeros((pl.MAX_PLACES + 1, gk.GAP_SIZE))
        ck.set_place(q, self.device, place)
        bolt, nut = self._pair.bolt.packed, self._pair.nut.packed
        count = pl.find_places(reach, place, self.device, bolt, nut, self._threads, self._work, places)
        return places[:count]

    def same(self, q: Floats, wanted: Floats) -> Floats:
        """The place of the same features nearest to one found before."""
        found = self.places(q, 0.02)
        found = found[found[:, gk.G_PAIR] == wanted[gk.G_PAIR]]
        points = slice(gk.G_POINT, gk.G_POINT + 3)
        return np.asarray(min(found, key=lambda place: float(np.abs(place[points] - wanted[points]).sum())))


def test_the_rotation_is_the_exponential_and_its_derivative_the_right_one() -> None:
    rng = np.random.default_rng(1)
    command = commanded_rotation(3.0, -2.0, 40.0, About.NUT)
    for size in (0.0, 1e-8, 1e-3, 0.3, 1.0):
        e = rng.standard_normal(3)
        e *= size / np.linalg.norm(e)
        q = np.concatenate([e, [0.1, 0.2, 0.3]])
        place = np.zeros(ck.PLACE_SIZE)
        ck.set_place(q, device(command), place)
        turned = command.reshape(3, 3) @ expm(cross(e))
        assert np.abs(place[:9].reshape(3, 3) - turned).max() < 2e-15
        assert np.abs(place[9:12] + CENTRE * turned[:, 2] - q[3:]).max() < 1e-15
        # exp(e + d) = exp(e) exp(J d + Q(d, d) / 2 + ...): what is left is of the third order.
        jacobian = place[ck.N_JACOBIAN : ck.N_JACOBIAN + 9].reshape(3, 3)
        second = np.empty(3)
        for step, bound in ((1e-3, 1e-9), (1e-2, 1e-6)):
            d = step * rng.standard_normal(3)
            w = jacobian @ d
            for i in range(3):
                for j in range(3):
                    ck.second_order(place, i, j, second)
                    w = w + 0.5 * d[i] * d[j] * second
            left = expm(cross(e + d)) - expm(cross(e)) @ expm(cross(w))
            assert np.abs(left).max() < 10.0 * bound


def test_commands_about_the_bolts_axis_keep_the_tilt_in_space() -> None:
    about_nut = commanded_rotation(3.0, -2.0, 70.0, About.NUT).reshape(3, 3)
    about_bolt = commanded_rotation(3.0, -2.0, 70.0, About.BOLT).reshape(3, 3)
    c, s = math.cos(math.radians(70.0)), math.sin(math.radians(70.0))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    tilt = commanded_rotation(3.0, -2.0, 0.0, About.NUT).reshape(3, 3)
    assert np.abs(about_nut - turn @ tilt).max() < 1e-15
    assert np.abs(about_bolt - tilt @ turn).max() < 1e-15


def test_gradients_and_curvatures_of_all_features_are_those_of_differences() -> None:
    pair = quarter_twenty_unc()
    rng = np.random.default_rng(1)
    seen: dict[int, int] = {}
    h = 1e-6
    for _ in range(80):
        roll, pitch, phase = rng.uniform([-4.0, -4.0, -30.0], [4.0, 4.0, 30.0])
        command = commanded_rotation(roll, pitch, phase, About.NUT)
        search = Search(pair, command)
        q = np.concatenate(
            [rng.uniform(-0.02, 0.02, 3), rng.uniform(-0.004, 0.004, 2), [CENTRE + rng.uniform(-0.012, 0.002)]]
        )
        for place in search.places(q, 0.01).copy():
            kind = int(place[gk.G_PAIR])
            gradient = place[gk.G_GRADIENT : gk.G_GRADIENT + 6]
            hessian = place[gk.G_HESSIAN : gk.G_HESSIAN + 36].reshape(6, 6)
            if seen.get(kind, 0) == 3 or np.abs(hessian).max() > 300.0:
                # Of a place that hardly bends the next differences of the Hessian are large.
                continue
            by_difference, curved = np.zeros(6), np.zeros((6, 6))
            crosses = False
            for j in range(6):
                step = h * np.eye(6)[j]
                after, before = search.same(q + step, place), search.same(q - step, place)
                by_difference[j] = (after[gk.G_VALUE] - before[gk.G_VALUE]) / (2.0 * h)
                curved[j] = (after[gk.G_GRADIENT :][:6] - before[gk.G_GRADIENT :][:6]) / (2.0 * h)
                # Second derivatives jump where the point crosses into another region of a profile.
                for part in (after, before):
                    change = part[gk.G_HESSIAN :][:36] - place[gk.G_HESSIAN :][:36]
                    crosses = crosses or np.abs(change).max() > 0.05
            if crosses:
                continue
            seen[kind] = seen.get(kind, 0) + 1
            assert np.abs(gradient - by_difference).max() < 1e-6
            assert np.abs(hessian - curved).max() < 2e-4
            assert np.abs(hessian - hessian.T).max() < 1e-9
    features = (EDGE_EDGE, EDGE_SURFACE, BASE_EDGE, EDGE_THREAD, THREAD_EDGE, THREAD_THREAD)
    assert {kind: seen.get(kind, 0) for kind in features} == dict.fromkeys(features, 3)


def test_the_crossing_of_both_edges_is_no_place_where_the_overlap_goes_on_rising() -> None:
    """Beside the crossing the surface takes over from the thread while its depth still rises: one place, the peak's."""
    pair = quarter_twenty_unc()
    search = Search(pair, commanded_rotation(4.0, -3.0, 70.0, About.NUT))
    rng = np.random.default_rng(7)
    seen = 0
    for _ in range(200):
        turn = np.array([-0.0322761, 0.0212464, 0.0]) + rng.uniform(-1e-3, 1e-3, 3) * [1.0, 1.0, 0.0]
        q = np.concatenate([turn, [0.0, 0.0, 0.0]])
        q[3:] += (
            CENTRE * np.asarray(commanded_rotation(4.0, -3.0, 70.0, About.NUT).reshape(3, 3) @ expm(cross(turn)))[:, 2]
        )
        q[5] += 0.0059
        place = np.zeros(ck.PLACE_SIZE)
        ck.set_place(q, search.device, place)
        for found in search.places(q, 0.002):
            if int(found[gk.G_PAIR]) not in (EDGE_EDGE, EDGE_SURFACE):
                continue
            seen += 1
            beside = [
                gk.edge_depth(True, found[gk.G_THETA] + step, place, pair.bolt.packed, pair.nut.packed)
                for step in (-1e-5, -1e-6, 1e-6, 1e-5)
            ]
            assert max(beside) < found[gk.G_VALUE] + 1e-15
    assert seen >= 200


def test_derivatives_of_a_point_that_stays_are_those_of_its_own_depth() -> None:
    """Away from the deepest point, too: that of an edge or thread 0.03 rad beside it."""
    pair = quarter_twenty_unc()
    bolt, nut = pair.bolt.packed, pair.nut.packed
    rng = np.random.default_rng(2)
    seen: set[int] = set()
    h = 1e-6

    def depth(search: Search, q: Floats, kind: int, theta: float, z: float) -> Floats:
        place, gap = np.zeros(ck.PLACE_SIZE), np.zeros(gk.GAP_SIZE)
        ck.set_place(q, search.device, place)
        gk.set_gap(kind, theta, z, True, place, search.device, bolt, nut, np.empty(gk.GAP_WORK), gap)
        return gap

    for _ in range(40):
        roll, pitch, phase = rng.uniform([-4.0, -4.0, -30.0], [4.0, 4.0, 30.0])
        search = Search(pair, commanded_rotation(roll, pitch, phase, About.NUT))
        q = np.concatenate(
            [rng.uniform(-0.02, 0.02, 3), rng.uniform(-0.004, 0.004, 2), [CENTRE + rng.uniform(-0.012, 0.002)]]
        )
        for found in search.places(q, 0.01).copy():
            kind = int(found[gk.G_PAIR])
            if kind == EDGE_EDGE or kind in seen:
                continue
            at = (kind, found[gk.G_THETA] + 0.03, found[gk.G_Z])
            here = depth(search, q, *at)
            beside = [(depth(search, q + s, *at), depth(search, q - s, *at)) for s in h * np.eye(6)]
            slopes = np.array([(after[gk.G_VALUE] - before[gk.G_VALUE]) / (2.0 * h) for after, before in beside])
            gradients = slice(gk.G_GRADIENT, gk.G_GRADIENT + 6)
            bends = np.array([(after[gradients] - before[gradients]) / (2.0 * h) for after, before in beside])
            hessian = here[gk.G_HESSIAN : gk.G_HESSIAN + 36].reshape(6, 6)
            if not here[gk.G_VALUE] < found[gk.G_VALUE] or np.abs(hessian).max() > 300.0:
                continue
            assert np.abs(here[gradients] - slopes).max() < 1e-6
            assert np.abs(hessian - bends).max() < 1e-5 * np.abs(hessian).max()
            seen.add(kind)
    assert seen == {EDGE_SURFACE, BASE_EDGE, EDGE_THREAD, THREAD_EDGE, THREAD_THREAD}
