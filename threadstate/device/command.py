"""A device's command as the kernels take it: its rotation at a pose, and over all phases; the flanks of a pair."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate.contact._stage_kernel import rotation
from threadstate.device import _leg_kernel as lk
from threadstate.device import _strip_kernel as st
from threadstate.device.model import About, Device
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits

Floats = NDArray[np.float64]

LONGEST_STEP_DEG, LONGEST_STEP_WITH_FRICTION_DEG = 2.0, 1.0
"""The longest step of the phase where no other is asked for."""


def commanded_rotation(roll_deg: float, pitch_deg: float, phase_deg: float, about: About) -> Floats:
    """The commanded rotation by rows, shape (9,): bolt to nut (forces, section 4)."""
    out = np.zeros(12)
    roll, pitch, phase = math.radians(roll_deg), math.radians(pitch_deg), math.radians(phase_deg)
    if about is About.NUT:
        rotation(roll, pitch, phase, out)
        return out[:9]
    turn = np.zeros(12)
    rotation(roll, pitch, 0.0, out)
    rotation(0.0, 0.0, phase, turn)
    return np.asarray(out[:9].reshape(3, 3) @ turn[:9].reshape(3, 3)).ravel()


def command_numbers(
    device: Device, roll_deg: float, pitch_deg: float, height: float, longest_step_deg: float = LONGEST_STEP_DEG
) -> Floats:
    """A tilt, the height of the command, the push and the longest step as the kernels take them for every phase."""
    numbers = np.zeros(lk.COMMAND_SIZE)
    numbers[lk.M_TILT : lk.M_TILT + 9] = commanded_rotation(roll_deg, pitch_deg, 0.0, device.about)
    numbers[lk.M_ABOUT_BOLT] = device.about is About.BOLT
    numbers[lk.M_HEIGHT] = height
    numbers[lk.M_PUSH] = device.push
    numbers[lk.M_LONGEST] = math.radians(longest_step_deg)
    return numbers


def strip_numbers(pair: Pair) -> Floats:
    """What the kernels know of a pair's flanks: of flanks that nowhere face each other that they have no strip."""
    numbers = np.empty(st.STRIP_SIZE)
    bolt, nut = pair.bolt, pair.nut
    numbers[st.S_LOW] = max(bolt.radius(bolt.boundaries[1]), nut.radius(nut.boundaries[1]))
    numbers[st.S_HIGH] = min(bolt.radius(bolt.boundaries[2]), nut.radius(nut.boundaries[2]))
    numbers[st.S_STARTS] = pair.starts
    numbers[st.S_DOWN] = axial_limits(pair)[0] if numbers[st.S_LOW] < numbers[st.S_HIGH] else 0.0
    return numbers
