"""A sampled path, computed and recorded."""

from __future__ import annotations

from threadstate.chances.model import Record
from threadstate.chances.record import record_of
from threadstate.chances.sampling import Uncertainty, approach
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathStoppedError
from threadstate.success.bounded import BoundedWatch
from threadstate.thread.pair import Pair


def computed_record(
    pair: Pair, device: Device, strategy: Strategy, uncertainty: Uncertainty, point_limit: int, index: int
) -> Record:
    """The record of the sample with this number; the arguments are those of ``ChancesInputs``.

    What this imports decides which samples are which: see ``threadstate.chances.inputs``.
    """
    one = approach(uncertainty, index)
    pose_deg = (one.roll_deg, one.pitch_deg, one.phase_deg)
    watch = BoundedWatch(point_limit)
    try:
        with watch.looking():
            path = assemble_pose(pair, *pose_deg, device, strategy, mu=one.mu, watch=watch)
    except PathStoppedError:
        return Record(one, AssemblyOutcome.UNDECIDED, (), True, None, None, None, None, None, ())
    return record_of(path, one, pair.lead)
