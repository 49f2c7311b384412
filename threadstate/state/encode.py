"""The geometry of states as records, which kernels read: the reverse of :mod:`threadstate.state.decode`."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.state.decode import FEATURES, FLAG_BITS
from threadstate.state.model import Contact, ContactState
from threadstate.thread.regions import NUT_REGIONS, SIDE_REGIONS

_BITS = {flag: bit for bit, flag in FLAG_BITS}


def geometry_records(states: Sequence[ContactState]) -> NDArray[np.float64]:
    """Records of shape (n, RECORD_SIZE) with flags, poses and contacts of states; their turns and lengths are NaN."""
    records = np.zeros((len(states), rk.RECORD_SIZE))
    records[:, rk.O_LAMBDA : rk.O_CONTACTS] = math.nan
    for record, state in zip(records, states, strict=True):
        record[rk.O_FLAGS] = sum(_BITS[flag] for flag in state.flags)
        record[rk.O_POSES] = len(state.poses)
        record[rk.O_CONTACTS] = len(state.contacts)
        poses = [number for pose in state.poses for row in (*pose.rotation, pose.translation) for number in row]
        record[rk.O_POSE : rk.O_POSE + len(poses)] = poses
        contacts = [number for contact in state.contacts for number in _numbers(contact)]
        record[rk.O_CONTACT : rk.O_CONTACT + len(contacts)] = contacts
    return records


def _numbers(contact: Contact) -> tuple[float, ...]:
    """A contact in the order of a record."""
    return (
        contact.stage,
        FEATURES.index(contact.features),
        *contact.point,
        *contact.point_bolt,
        *contact.normal,
        SIDE_REGIONS.index(contact.bolt_region),
        NUT_REGIONS.index(contact.nut_region),
        contact.bolt_margin,
        contact.nut_margin,
    )
