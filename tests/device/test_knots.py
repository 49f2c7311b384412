"""Points of a path and their derivatives, against points beside them."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _descent_kernel as dk
from threadstate.device import _gap_kernel as gk
from threadstate.device import _knot_kernel as kk
from threadstate.device import _leg_kernel as lk
from threadstate.device import _places_kernel as pl
from threadstate.device import _rest_kernel as rk
from threadstate.device import _span_kernel as sp
from threadstate.device._settle_kernel import END_OVERLAP, END_TOLERANCE, LAST_STEPS
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyPoint, Held
from threadstate.device.command import command_numbers
from threadstate.device.model import About, Device, default_device
from threadstate.device.settle import device_numbers
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
BOLT, NUT = UNC.bolt.packed, UNC.nut.packed
R = UNC.nominal_diameter / 2.0
ROLL_DEG, PITCH_DEG, PHASE_DEG = 1.4, -2.6, 209.0
STEP = math.radians(0.1)


class Settled(NamedTuple):
    """A bolt at rest at a command, its coordinates and its knot."""

    q: Floats
    knot: kk.Knot
    scene: rk.Scene


def settled_at(device: Device, point: AssemblyPoint, step: float) -> Settled | None:
    """The equilibrium that is a step of the phase (rad) from a point's, if it is found to the last digits."""
    numbers = device_numbers(UNC, device)
    numbers[ck.D_FINE] = pl.FINE
    command = command_numbers(device, ROLL_DEG, PITCH_DEG, 0.0)
    place, q = np.empty(ck.PLACE_SIZE), np.zeros(ck.COORDINATES)
    phase = math.radians(point.phase_deg)
    lk.set_phase(phase, command, numbers)
    q[:3] = np.radians(point.rotation_deg)
    ck.set_place(q, numbers, place)
    q[3:] += np.array(point.pose.translation) - place[ck.N_OFFSET : ck.N_OFFSET + 3]
    command[lk.M_HEIGHT] = q[5] - point.shift[2] - numbers[ck.D_PLACE + 2]
    lk.set_phase(phase + step, command, numbers)
    scene = rk.Scene(numbers, BOLT, NUT, pl.new_threads(BOLT), rk.new_work())
    wanted = dk.Descent(device.push, 3e-3 * R, 1e-2 * R, LAST_STEPS, END_TOLERANCE, END_OVERLAP)
    status, found = dk.descend(q, wanted, scene)
    if status != dk.AT_REST:
        return None
    rates, knot = np.empty(ck.COORDINATES), kk.new_knot()
    lk.set_command_rates(command, numbers, rates)
    kk.set_knot(found, device.push, rates, scene, knot)
    return Settled(q, knot, scene)


def neighbours(device: Device) -> list[tuple[Settled, Settled, Settled]]:
    """Points on contacts of a path, each with the equilibria a step before and after it with the same contacts.

    Those where a contact goes over a crease between them, and the path with it, are left out: derivatives jump there.
    """
    path = assemble_pose(UNC, ROLL_DEG, PITCH_DEG, PHASE_DEG, device)
    found = []
    for point in [point for point in path.points if point.held is Held.CONTACTS][::15]:
        before, here, after = (settled_at(device, point, step) for step in (-STEP, 0.0, STEP))
        if before is None or here is None or after is None:
            continue
        spans = np.empty((sp.MAX_SPANS, sp.SPAN_SIZE))
        is_alike = True
        for one, other in ((before, here), (here, after)):
            total = sp.set_spans(one.knot, other.knot, device.push, one.scene, spans)
            is_alike &= not sp.changes(total, one.knot, other.knot, spans)
            is_alike &= not sp.hides_change(total, STEP, one.knot, other.knot, spans, one.scene)
        bends = np.abs(before.knot.drift - after.knot.drift).max() > 0.01 * R
        if is_alike and not bends:
            found.append((before, here, after))
    assert len(found) > 4
    return found


@pytest.mark.parametrize("about", [About.NUT, About.BOLT])
def test_a_points_derivatives_are_those_of_differences(about: About) -> None:
    """Of coordinates, multipliers and gaps; a central difference over 0.2 deg."""
    device = replace(default_device().in_unit(UNC.unit), about=about)
    spans = np.empty((sp.MAX_SPANS, sp.SPAN_SIZE))
    compared = 0
    for before, here, after in neighbours(device):
        assert here.knot.numbers[kk.K_RATED] == 1
        slope = (after.q - before.q) / (2.0 * STEP)
        assert np.abs(here.knot.drift - slope).max() < 2e-3 * max(np.abs(slope).max(), R)
        total = sp.set_spans(before.knot, after.knot, device.push, before.scene, spans)
        for span in spans[:total]:
            if span[sp.SPAN_WHOLE] == 0.0:
                continue
            first = sp.SPAN_MULTIPLIER if span[sp.SPAN_WAS] > 0.0 else sp.SPAN_OPENING
            a, slope_a, b, slope_b = span[first : first + 4]
            size = max(abs(slope_a), abs(slope_b), device.push if first == sp.SPAN_MULTIPLIER else 1e-2 * R)
            assert abs(0.5 * (slope_a + slope_b) - (b - a) / (2.0 * STEP)) < 5e-3 * size
            compared += 1
    assert compared > 20


def test_places_are_the_same_ones_from_either_end() -> None:
    device = default_device().in_unit(UNC.unit)
    spans, back = np.empty((sp.MAX_SPANS, sp.SPAN_SIZE)), np.empty((sp.MAX_SPANS, sp.SPAN_SIZE))
    for _, here, after in neighbours(device):
        total = sp.set_spans(here.knot, after.knot, device.push, here.scene, spans)
        count = sp.set_spans(after.knot, here.knot, device.push, here.scene, back)
        pairs = {(int(span[sp.SPAN_FROM]), int(span[sp.SPAN_TO])) for span in spans[:total]}
        assert {(int(span[sp.SPAN_TO]), int(span[sp.SPAN_FROM])) for span in back[:count]} == pairs
        of_contacts = [span for span in spans[:total] if span[sp.SPAN_WAS] > 0.0]
        assert of_contacts
        for span in of_contacts:
            was, now = here.knot.places[int(span[sp.SPAN_FROM])], after.knot.places[int(span[sp.SPAN_TO])]
            assert math.dist(was[gk.G_POINT : gk.G_POINT + 3], now[gk.G_POINT : gk.G_POINT + 3]) < 0.05 * R


def test_the_least_of_a_cubic_is_that_of_many_samples() -> None:
    choose = random.Random(4)
    parts = np.linspace(0.0, 1.0, 100_001)
    for _ in range(300):
        a, a1, b, b1 = (choose.uniform(-1.0, 1.0) for _ in range(4))
        h = choose.choice((-0.3, 0.4, 2.0))
        cubic = (
            a
            + h * a1 * parts
            + (3.0 * (b - a) - h * (2.0 * a1 + b1)) * parts**2
            + (2.0 * (a - b) + h * (a1 + b1)) * parts**3
        )
        least = sp.least_between(a, a1, b, b1, h)
        assert least <= cubic.min() + 1e-12
        assert least == pytest.approx(cubic.min(), abs=1e-8)


@pytest.mark.parametrize(
    ("was", "now", "expected"),
    [
        ((0.4, -2.0, 0.0, 0.0), (0.0, 0.0, 0.3, 1.5), 0.2),
        ((0.0, 0.0, 0.6, -2.0), (0.5, 2.0, 0.0, 0.0), 0.3),
        ((0.4, 2.0, 0.0, 0.0), (0.0, 0.0, 0.3, 1.0), 0.7),
    ],
    ids=["lost, by its force before", "gained, by its gap before", "lost, by its gap after"],
)
def test_a_change_is_expected_where_a_force_or_a_gap_goes_to_zero(
    was: tuple[float, ...], now: tuple[float, ...], expected: float
) -> None:
    """Multiplier, its derivative, gap and its derivative at both ends of a step of 1."""
    span = np.zeros((1, sp.SPAN_SIZE))
    span[0, sp.SPAN_WAS], span[0, sp.SPAN_IS], span[0, sp.SPAN_WHOLE] = was[0] > 0.0, now[0] > 0.0, 1.0
    for end, numbers in enumerate((was, now)):
        span[0, sp.SPAN_MULTIPLIER + 2 * end : sp.SPAN_MULTIPLIER + 2 * end + 2] = numbers[:2]
        span[0, sp.SPAN_OPENING + 2 * end : sp.SPAN_OPENING + 2 * end + 2] = numbers[2:]
    assert sp.first_change(1, 1.0, span) == pytest.approx(expected)
    span[0, sp.SPAN_IS] = span[0, sp.SPAN_WAS]
    assert math.isnan(sp.first_change(1, 1.0, span))
