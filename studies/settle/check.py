"""A settled state checked apart from the solver: its pose, its forces and its potential, by the brute force."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.pose import pose_rotation
from oracle.rest import HeldBolt
from threadstate.device.model import About, Device, SettledState
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

OVERLAP = 8e-9
"""The most overlap of a settled state, in nominal radii: 1e-9 in on 1/4-20."""
APART = 1e-9
"""The widest gap between the parts, in nominal radii."""
RESIDUAL = 1e-9
"""The most that is left unbalanced, over the push."""
LOWER = 1e-10
"""By how much a place beside may be lower, in push times nominal radius: round-off of samples and heights."""
LEAST_STEP, LONGEST_STEP = 1e-5, 1e-3
"""Steps of the directions that are tried, in nominal radii."""
MOVED = 1e-12
"""Difference between a pose and the same from its deviation; lengths over the nominal radius."""


@dataclass(frozen=True)
class Checked:
    """What the checks of a settled state measured: lengths over the nominal radius, forces over the push.

    ``overlap`` is negative where the parts are apart; ``beyond`` is the number of places beside that are lower, beyond
    a barrier of the potential; ``faults`` say what contradicts the state.
    """

    overlap: float
    least_force: float
    residual: float
    beyond: int
    faults: tuple[str, ...]


def commanded(state: SettledState, about: About) -> Floats:
    """The commanded rotation, shape (3, 3)."""
    if about is About.NUT:
        return pose_rotation(state.roll_deg, state.pitch_deg, state.phase_deg)
    return np.asarray(pose_rotation(state.roll_deg, state.pitch_deg, 0.0) @ pose_rotation(0.0, 0.0, state.phase_deg))


def held_bolt(pair: Pair, device: Device, state: SettledState) -> HeldBolt:
    """The device at a settled state's command; the height of the first contact is the state's."""
    assert state.pose is not None
    assert state.shift is not None
    held = device.in_unit(pair.unit)
    command = commanded(state, held.about)
    up = state.pose.translation[2] + held.centre * state.pose.rotation[2][2]
    return HeldBolt(
        pair,
        command,
        np.array(held.stiffness),
        held.centre,
        held.push,
        up - state.shift[2] - held.centre * command[2, 2],
        held.twist_is_rigid,
    )


def place_of(state: SettledState) -> tuple[Floats, float]:
    """The place of a settled bolt as the brute force has it, and the height of its origin."""
    assert state.pose is not None
    assert state.shift is not None
    assert state.rotation_deg is not None
    return np.array([*np.radians(state.rotation_deg), *state.shift[:2]]), state.pose.translation[2]


def check(pair: Pair, device: Device, state: SettledState, directions: int, choose: np.random.Generator) -> Checked:
    """Check a settled state; so many random directions are tried."""
    held = held_bolt(pair, device, state)
    place, height = place_of(state)
    r = pair.nominal_diameter / 2.0
    faults = []
    if moved(held, state, place, height, r) > MOVED:
        faults.append("pose and deviation are not of one place")
    overlap = held.overlap(place, height) / r
    if not -APART < overlap < OVERLAP:
        faults.append(f"overlap of {overlap:.2e} r")
    start = held.overlap(np.zeros(5), held.first) / r
    if not -APART < start < OVERLAP:
        faults.append(f"at its first contact overlap of {start:.2e} r")
    forces = [float(np.dot(contact.force, contact.normal)) / held.push for contact in state.contacts]
    if not min(forces) >= 0.0:
        faults.append(f"a force of {min(forces):.2e} F")
    residual = unbalanced(held, state, place)
    if not residual < RESIDUAL:
        faults.append(f"{residual:.2e} F unbalanced")
    beyond = 0
    if directions > 0:
        ways = choose.standard_normal((directions, 5)) * (held.scale > 0.0)
        sizes = 10.0 ** choose.uniform(math.log10(LEAST_STEP), math.log10(LONGEST_STEP), directions) * r
        steps = (sizes / np.linalg.norm(ways, axis=1))[:, None] * ways * held.scale
        lower, beyond = held.free_beside(place, height, steps, LOWER * held.push * r)
        if lower > beyond:
            faults.append(f"{lower - beyond} of {directions} places beside are lower by {LOWER:.0e} F r and free")
    return Checked(overlap, min(forces), residual, beyond, tuple(faults))


def moved(held: HeldBolt, state: SettledState, place: Floats, height: float, r: float) -> float:
    """How far a state's pose is from the one of its deviation."""
    assert state.pose is not None
    turn = np.abs(held.rotation(place) - np.array(state.pose.rotation)).max()
    shift = np.abs(held.origin(place, height) - np.array(state.pose.translation)).max()
    return float(max(turn, shift / r))


def unbalanced(held: HeldBolt, state: SettledState, place: Floats) -> float:
    """The wrench that contacts, device and push leave, over the push (moments over the nominal radius)."""
    assert state.shift is not None
    vector = place[:3]
    gradient = held.stiffness @ np.concatenate([vector, state.shift])
    rotation = held.rotation(place)
    angle = float(np.linalg.norm(vector))
    cross = np.cross(vector, np.eye(3)).T
    half = 2.0 * math.sin(0.5 * angle) ** 2
    jacobian = np.eye(3)
    if angle > 0.0:
        jacobian = jacobian - half / angle**2 * cross + (angle - math.sin(angle)) / angle**3 * cross @ cross
    axes = rotation @ np.linalg.inv(jacobian).T
    force = -gradient[3:] - np.array([0.0, 0.0, held.push])
    moment = -axes @ gradient[:3]
    centre = held.command[:, 2] * held.centre + np.array([0.0, 0.0, held.first]) + np.array(state.shift)
    for contact in state.contacts:
        force = force + contact.force
        moment = moment + np.cross(np.array(contact.point) - centre, contact.force)
    if held.twist_is_rigid:
        free = axes[:, 2]
        moment = moment - free * (free @ moment) / (free @ free)
    return float(np.hypot(np.linalg.norm(force), 2.0 * np.linalg.norm(moment) / held.pair.nominal_diameter) / held.push)
