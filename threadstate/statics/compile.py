"""Loads the kernels of the statics, compiling those that the cache lacks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.state.model import ContactState
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics._friction_kernel import least_forces
from threadstate.statics._last_pose_kernel import set_contacts
from threadstate.statics.extras import Extra, extras_of
from threadstate.statics.load import Load
from threadstate.statics.rows import stored_statics
from threadstate.statics.solve import statics_of
from threadstate.statics.wrench_cone import contact_maps, opening
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair


def load_statics(pair: Pair, states: Sequence[ContactState]) -> None:
    """Call each kernel that is called from Python: of the states one has three contacts, one lies on a patch.

    On a strip of flank a load's friction is sought for a twentieth of a second, by the same kernels.
    """
    load_forces()
    stored_statics(pair, states)
    for state in states:
        extras_of(pair, state, statics_of(pair, state, Load(force=(0.1, 0.0, -1.0)), 0.5), [Extra.REACTION])


def load_forces() -> None:
    """Call what no level state calls, the contacts and the forces of three, and what strips alone do."""
    points, normals = np.eye(3), np.tile([0.0, 0.0, 1.0], (3, 1))
    pair = quarter_twenty_unc()
    set_contacts(np.zeros(RECORD_SIZE), pair.bolt.packed, pair.nut.packed, points.copy(), normals.copy())
    least_forces(np.array([0.0, 0.0, 0.1, 0.0, 0.0, -1.0]), 1.0, points, normals, np.zeros(9))
    turn_effort(1.0, 0.0, points, normals, 0.1, 1.0)
    opening(contact_maps(points, normals, 1.0))
