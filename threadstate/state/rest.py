"""Whether a bolt rests in the last pose of a state (method, section 8).

Only a stable or quasi-stable state rests whose embedment is within tolerance. The last pose of any other is where the
procedure ended: the bolt goes on from there, or its solid is in the nut's.
"""

from __future__ import annotations

from threadstate.state.model import StateClass


def rests(state_class: StateClass, embedment_margin: float | None) -> bool:
    """Whether a state of this class and distance of its embedment from the tolerance (None: flush) rests."""
    return state_class is not StateClass.UNSTABLE_TWO_POINT and (embedment_margin is None or embedment_margin >= 0.0)
