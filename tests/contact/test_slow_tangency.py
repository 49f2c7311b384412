"""Thread on thread where phi grows slowly with the turn, so that round-off of phi is much of a step in time."""

from __future__ import annotations

import numpy as np

from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()


def test_a_contact_at_which_phi_grows_slowly_is_found_at_every_phase() -> None:
    phases = np.linspace(358.724996, 358.725004, 120).tolist()
    states = solve_poses(PAIR, [(4.0, 1.0, phase) for phase in phases])
    assert [state.contacts[-1].features for state in states] == [FeaturePair.THREAD_THREAD] * len(phases)
    turns = [state.mu_deg for state in states if state.mu_deg is not None]
    np.testing.assert_allclose(turns, np.linspace(turns[0], turns[-1], len(phases)), atol=1e-9)
