"""Paths of a bolt that a device settles on the nut and turns (forces, section 5)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _rest_kernel as rest
from threadstate.device import _settle_kernel as sk
from threadstate.device import _strip_kernel as st
from threadstate.device import _turn_kernel as tk
from threadstate.device._certificate_kernel import FREE
from threadstate.device.assembly_model import (
    AssemblyEnergy,
    AssemblyOutcome,
    AssemblyPath,
    AssemblyPoint,
    AssemblyTravel,
    EventKind,
    Held,
    PathEvent,
    Strategy,
)
from threadstate.device.assembly_outcome import outcome_of
from threadstate.device.flush import level_numbers
from threadstate.device.model import About, Device, LoadedContact, Outcome, SettledFlag, SettledState, default_device
from threadstate.device.settle import (
    FEATURES,
    REASONS,
    check_pair,
    commanded_rotation,
    device_numbers,
    settled_rows,
    settled_state,
    vector_of,
)
from threadstate.errors import InvalidValueError
from threadstate.state.model import FeaturePair, StagePose
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits

__all__ = ["assemble_pose"]

Floats = NDArray[np.float64]

COUNTER_CLOCKWISE_DEG, CLOCKWISE_DEG = 360.0, 270.0

EVENTS = {
    tk.GAINED: EventKind.GAINED,
    tk.LOST: EventKind.LOST,
    tk.MOVED: EventKind.MOVED,
    tk.FALL: EventKind.FALL,
    tk.ON_FLUSH: EventKind.ON_SURFACE,
    tk.OFF_FLUSH: EventKind.OFF_SURFACE,
    tk.ON_FLANK: EventKind.ON_STRIP,
    tk.OFF_STRIP: EventKind.OFF_STRIP,
    tk.BRIDGED: EventKind.BRIDGED,
}

HELD = (Held.CONTACTS, Held.SURFACE, Held.STRIP)


def assemble_pose(
    pair: Pair,
    roll_deg: float,
    pitch_deg: float,
    phase_deg: float,
    device: Device | None = None,
    strategy: Strategy = Strategy.CCW_THEN_CW,
    *,
    mu: float = 0.0,
) -> AssemblyPath:
    """The path of a bolt that settles at a commanded pose and is turned; angles in degrees.

    Forces, section 5, without friction; a left-hand bolt is turned the other way round. The device is the default one
    of forces, section 4, unless another is given.
    The path is a sequence of equilibria, at most 2 deg of phase apart, and 0.05 deg where contacts change. The same
    input gives the same bits.

    Raises:
        InvalidValueError: as :func:`threadstate.device.settle.settle_pose`.
    """
    ((roll, pitch, phase),) = wanted = checked_poses([(roll_deg, pitch_deg, phase_deg)])
    if mu != 0.0:
        raise InvalidValueError("mu", mu, "0: paths are computed without friction")
    check_pair(pair)
    held = (device or default_device()).in_unit(pair.unit)
    numbers = device_numbers(pair, held)
    rotations, rows = settled_rows(pair, held, numbers, wanted)
    row = tuple(part[0] for part in rows)
    start = settled_state(pair, held, numbers, wanted[0], rotations[0], row)
    if start.outcome is not Outcome.SETTLED:
        outcome = AssemblyOutcome.SLIPPED if start.outcome is Outcome.SLIPPED else AssemblyOutcome.UNDECIDED
        return AssemblyPath(start, strategy, mu, outcome, start.flags, (), (), None, None, None)
    command = np.zeros(tk.COMMAND_SIZE)
    command[:9] = commanded_rotation(roll, pitch, 0.0, held.about)
    command[tk.M_ABOUT_BOLT] = held.about is About.BOLT
    command[tk.M_HEIGHT] = row[0][sk.R_HEIGHT]
    command[tk.M_PUSH] = held.push
    legs = _turned(pair, numbers, command, row, float(phase), strategy)
    return _path(pair, held, numbers, command, legs, start, strategy)


def _turned(
    pair: Pair,
    numbers: Floats,
    command: Floats,
    row: tuple[Floats, ...],
    phase_deg: float,
    strategy: Strategy,
) -> list[tk.Leg]:
    """The legs of a strategy, from the settled state's row on; the last may have ended early."""
    numbers = numbers.copy()
    is_flush = row[0][sk.R_STATUS] == rest.FLUSH
    phase = math.radians(phase_deg)
    q = row[1].copy()
    if is_flush:
        tk.set_phase(phase, command, numbers)
        q, _ = level_numbers(numbers)
    kind = tk.ON_SURFACE if is_flush else tk.ON_CONTACTS
    # A left-hand bolt is turned the other way round: clockwise takes it out.
    hand = math.copysign(1.0, pair.lead)
    plan = [(-CLOCKWISE_DEG * hand, False)]
    if strategy is Strategy.CCW_THEN_CW:
        plan.insert(0, (COUNTER_CLOCKWISE_DEG * hand, True))
    legs: list[tk.Leg] = []
    for turn_deg, stops_at_snap in plan:
        leg = new_leg()
        status, kind = tk.turn_with(
            q,
            kind,
            phase,
            phase + math.radians(turn_deg),
            stops_at_snap,
            command,
            numbers,
            strip_numbers(pair),
            pair.bolt.packed,
            pair.nut.packed,
            leg,
        )
        legs.append(leg)
        phase = float(leg[1][int(leg[0][tk.L_POINTS]) - 1, tk.T_PHASE])
        if status != (tk.SNAPPED if stops_at_snap else tk.TURNED):
            break
    return legs


def strip_numbers(pair: Pair) -> Floats:
    """What the kernels know of a pair's flanks."""
    numbers = np.empty(st.STRIP_SIZE)
    bolt, nut = pair.bolt, pair.nut
    numbers[st.S_DOWN] = axial_limits(pair)[0]
    numbers[st.S_LOW] = max(bolt.radius(bolt.boundaries[1]), nut.radius(nut.boundaries[1]))
    numbers[st.S_HIGH] = min(bolt.radius(bolt.boundaries[2]), nut.radius(nut.boundaries[2]))
    numbers[st.S_STARTS] = pair.starts
    return numbers


def new_leg() -> tk.Leg:
    """The arrays of a leg for the kernels."""
    return (
        np.zeros(tk.LEG_SIZE),
        np.zeros((tk.MAX_POINTS, tk.POINT_SIZE)),
        np.zeros((tk.MAX_POINTS, tk.MAX_CONTACTS, tk.CONTACT_SIZE)),
        np.zeros((tk.MAX_EVENTS, tk.EVENT_SIZE)),
    )


def _path(
    pair: Pair,
    device: Device,
    numbers: Floats,
    command: Floats,
    legs: list[tk.Leg],
    start: SettledState,
    strategy: Strategy,
) -> AssemblyPath:
    """The path of its legs."""
    points: list[AssemblyPoint] = []
    events: list[PathEvent] = []
    work, falls = 0.0, 0.0
    for result, rows, contacts, happened in legs:
        count = int(result[tk.L_POINTS])
        found = happened[: int(result[tk.L_EVENTS])]
        part = [_point(rows[i], contacts[i], numbers, command) for i in range(count)]
        # A leg begins where the one before ended.
        points += part[1:] if points else part
        events += [_event(event) for event in found]
        fallen = found[found[:, tk.E_KIND] == tk.FALL]
        falls += float(fallen[:, tk.E_LOSS].sum())
        torque, phase = rows[:count, tk.T_TORQUE], rows[:count, tk.T_PHASE]
        work += float((0.5 * (torque[1:] + torque[:-1]) * np.diff(phase)).sum())
        if result[tk.L_STATUS] == tk.SNAPPED:
            events.append(_snap(points))
    first, last = points[0], points[-1]
    elastic = last.elastic_energy - first.elastic_energy
    push = (first.potential - first.elastic_energy) - (last.potential - last.elastic_energy)
    energy = AssemblyEnergy(work, push, elastic, 0.0, falls, work + push - elastic - falls)
    status = int(legs[-1][0][tk.L_STATUS])
    outcome, margins = outcome_of(pair, device, strategy, legs, points)
    flags: tuple[SettledFlag, ...] = ()
    if outcome is AssemblyOutcome.UNDECIDED:
        flags = (REASONS.get(status - tk.FAILED, SettledFlag.UNSETTLED),)
    elif int(legs[-1][0][tk.L_OVERLAP]) != FREE:
        outcome, flags = AssemblyOutcome.UNDECIDED, (SettledFlag.OVERLAP,)
    travel = AssemblyTravel(
        max(abs(point.torque) for point in points),
        max(math.hypot(*point.rotation_deg) for point in points),
        max(math.hypot(*point.shift[:2]) for point in points),
    )
    return AssemblyPath(start, strategy, 0.0, outcome, flags, tuple(events), tuple(points), energy, margins, travel)


def _point(row: Floats, contacts: Floats, numbers: Floats, command: Floats) -> AssemblyPoint:
    numbers = numbers.copy()
    tk.set_phase(row[tk.T_PHASE], command, numbers)
    q = row[tk.T_COORDINATES : tk.T_COORDINATES + ck.COORDINATES]
    pose = row[tk.T_POSE : tk.T_POSE + 12]
    return AssemblyPoint(
        math.degrees(row[tk.T_PHASE]),
        HELD[int(row[tk.T_KIND])],
        StagePose(tuple(vector_of(line) for line in pose[:9].reshape(3, 3)), vector_of(pose[9:])),  # type: ignore[arg-type]
        vector_of(q[3:] - numbers[ck.D_PLACE : ck.D_PLACE + 3]),
        vector_of(np.degrees(q[:3])),
        tuple(_contact(contact) for contact in contacts[: int(row[tk.T_COUNT])]),
        float(row[tk.T_TORQUE]),
        float(row[tk.T_ENERGY]),
        float(row[tk.T_POTENTIAL]),
    )


def _contact(contact: Floats) -> LoadedContact:
    normal = contact[st.C_NORMAL : st.C_NORMAL + 3]
    return LoadedContact(
        vector_of(contact[st.C_POINT : st.C_POINT + 3]),
        vector_of(normal),
        FEATURES[int(contact[st.C_PAIR])],
        vector_of(contact[st.C_FORCE] * normal),
    )


def _event(event: Floats) -> PathEvent:
    kind = EVENTS[int(event[tk.E_KIND])]
    phase_deg, from_deg = math.degrees(event[tk.E_PHASE]), math.degrees(event[tk.E_BEFORE])
    point = vector_of(event[tk.E_POINT : tk.E_POINT + 3])
    if kind is EventKind.FALL:
        drop, way, loss = (float(number) for number in event[[tk.E_DROP, tk.E_WAY, tk.E_LOSS]])
        return PathEvent(kind, phase_deg, from_deg, point=point, drop=drop, way=way, energy=loss)
    if kind in (EventKind.GAINED, EventKind.LOST, EventKind.MOVED):
        before, after = (_features(event[i]) for i in (tk.E_OLD_PAIR, tk.E_PAIR))
        return PathEvent(kind, phase_deg, from_deg, before, after, point)
    return PathEvent(kind, phase_deg, from_deg)


def _features(index: float) -> FeaturePair | None:
    return FEATURES[int(index)] if index >= 0.0 else None


def _snap(points: list[AssemblyPoint]) -> PathEvent:
    """The snap at the last point: the descent within its span of phase."""
    span = math.degrees(tk.SNAP_SPAN) * (1.0 + 1e-9)
    last = points[-1]
    near = [point for point in points if abs(last.phase_deg - point.phase_deg) <= span]
    highest = max(near, key=lambda point: point.pose.translation[2])
    drop = highest.pose.translation[2] - last.pose.translation[2]
    way = math.dist(highest.pose.translation, last.pose.translation)
    return PathEvent(EventKind.SNAP, last.phase_deg, highest.phase_deg, drop=drop, way=way)
