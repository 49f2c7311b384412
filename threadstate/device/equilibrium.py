"""The balance and the stability of a held bolt, computed again from what contacts and device do (forces, section 4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _gap_kernel as gk
from threadstate.device.model import TWIST, Device, LoadedContact
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

BALANCED = 1e-9
"""Largest residual of an equilibrium, over the push."""


def device_wrench(device: Device, q: Floats, pose: Floats, numbers: Floats) -> tuple[Floats, Floats, Floats]:
    """The device's force and moment about the compliance centre in the nut's axes, and its moment's free direction.

    That of a rigid twist is what the device can supply besides, as much as is needed; else it is zero.
    """
    deviation = np.concatenate([q[:3], q[3:] - numbers[ck.D_PLACE : ck.D_PLACE + 3]])
    gradient = np.array(device.stiffness) @ deviation
    place = np.empty(ck.PLACE_SIZE)
    ck.set_place(q, numbers, place)
    jacobian = place[ck.N_JACOBIAN : ck.N_JACOBIAN + 9].reshape(3, 3)
    matrix = pose[:9].reshape(3, 3)
    to_moment = matrix @ np.linalg.inv(jacobian).T
    free = to_moment[:, TWIST] if device.twist_is_rigid else np.zeros(3)
    return -gradient[3:], -to_moment @ gradient[:3], free


def balance(
    pair: Pair, device: Device, q: Floats, pose: Floats, numbers: Floats, contacts: Sequence[LoadedContact]
) -> float:
    """The wrench that is not balanced over the push, moments over the nominal radius."""
    force, moment, free = device_wrench(device, q, pose, numbers)
    force = force - np.array([0.0, 0.0, device.push])
    for contact in contacts:
        force = force + np.array(contact.force)
        moment = moment + np.cross(np.array(contact.point) - q[3:], contact.force)
    if free.any():
        moment = moment - free * (free @ moment) / (free @ free)
    size = np.hypot(np.linalg.norm(force), np.linalg.norm(moment) / (pair.nominal_diameter / 2.0))
    return float(size / device.push)


def stability(pair: Pair, q: Floats, numbers: Floats, places: Floats, multipliers: Floats) -> float | None:
    """The least second derivative of the potential over motions that keep the contacts; None where there are none.

    It is over a unit of length in the metric diag(r^2, r^2, r^2, 1, 1, 1) at the bolt's origin.
    """
    free = [0, 1, 3, 4, 5] if numbers[ck.D_RIGID] > 0.0 else [0, 1, 2, 3, 4, 5]
    hessian = numbers[ck.D_STIFFNESS :].reshape(6, 6).copy()
    for place, multiplier in zip(places, multipliers, strict=True):
        hessian += multiplier * place[gk.G_HESSIAN : gk.G_HESSIAN + 36].reshape(6, 6)
    normals = places[:, gk.G_GRADIENT : gk.G_GRADIENT + 6][:, free]
    place = np.empty(ck.PLACE_SIZE)
    ck.set_place(q, numbers, place)
    matrix = place[ck.N_ROTATION : ck.N_ROTATION + 9].reshape(3, 3)
    turn = np.zeros((3, 6))
    turn[:, :3] = place[ck.N_JACOBIAN : ck.N_JACOBIAN + 9].reshape(3, 3)
    shift = np.zeros((3, 6))
    shift[:, 3:] = np.eye(3)
    shift -= matrix @ np.cross(turn, numbers[ck.D_CENTRE] * np.array([0.0, 0.0, 1.0]), axis=0)
    r = pair.nominal_diameter / 2.0
    metric = (r * r * turn.T @ turn + shift.T @ shift)[np.ix_(free, free)]
    inverse = np.linalg.inv(np.linalg.cholesky(metric))
    scaled = inverse @ hessian[np.ix_(free, free)] @ inverse.T
    constraints = normals @ inverse.T
    _, sizes, basis = np.linalg.svd(constraints)
    rank = int((sizes > 1e-12 * sizes[:1].max(initial=0.0)).sum())
    motions = basis[rank:]
    if len(motions) == 0:
        return None
    return float(np.linalg.eigvalsh(motions @ scaled @ motions.T)[0])
