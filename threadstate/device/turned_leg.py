"""A turn without friction, from the kernels' rows to points and events."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _leg_kernel as lk
from threadstate.device import _strip_kernel as st
from threadstate.device.assembly_model import AssemblyPoint, Held, PathEvent, PathEventKind
from threadstate.device.model import LoadedContact
from threadstate.device.settle import FEATURES, vector_of
from threadstate.state.model import FeaturePair, StagePose, Vector

Floats = NDArray[np.float64]

EVENTS = {
    lk.GAINED: PathEventKind.GAINED,
    lk.LOST: PathEventKind.LOST,
    lk.MOVED: PathEventKind.MOVED,
    lk.FALL: PathEventKind.FALL,
    lk.ON_FLUSH: PathEventKind.ON_SURFACE,
    lk.OFF_FLUSH: PathEventKind.OFF_SURFACE,
    lk.ON_FLANK: PathEventKind.ON_STRIP,
    lk.OFF_STRIP: PathEventKind.OFF_STRIP,
    lk.BRIDGED: PathEventKind.BRIDGED,
}

HELD = (Held.CONTACTS, Held.SURFACE, Held.STRIP)


def new_leg() -> lk.Leg:
    """The arrays of a leg for the kernels."""
    return (
        np.zeros(lk.LEG_SIZE),
        np.zeros((lk.MAX_POINTS, lk.POINT_SIZE)),
        np.zeros((lk.MAX_POINTS, st.MAX_CONTACTS, st.CONTACT_SIZE)),
        np.zeros((lk.MAX_EVENTS, lk.EVENT_SIZE)),
    )


@dataclass(frozen=True)
class RunningTurn:
    """A leg without friction, as :func:`threadstate.device._turn_kernel.turn_with` sets it."""

    leg: lk.Leg

    def reached(self) -> tuple[int, float | None]:
        """How many points it has, and the phase of the last one in degrees."""
        result, rows, _, _ = self.leg
        count = int(result[lk.L_POINTS])
        return count, math.degrees(rows[count - 1, lk.T_PHASE]) if count else None

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """The events up to a phase that it has reached: those of a step are all there once its point is."""
        result, rows, _, happened = self.leg
        if phase_deg is None:
            return []
        # The last row of a full list is overwritten.
        found = [turned_event(event) for event in happened[: min(int(result[lk.L_EVENTS]), lk.MAX_EVENTS - 1)]]
        return events_up_to(phase_deg, math.degrees(rows[0, lk.T_PHASE]), found)

    def stop(self) -> None:
        """Have the kernel end it, as after its last descent."""
        self.leg[0][lk.L_DESCENTS] = math.inf


def events_up_to(phase_deg: float, start_deg: float, events: list[PathEvent]) -> list[PathEvent]:
    """The events of a turn from a phase up to another one."""
    return [event for event in events if abs(event.phase_deg - start_deg) <= abs(phase_deg - start_deg)]


def turned_point(row: Floats, contacts: Floats, numbers: Floats, command: Floats) -> AssemblyPoint:
    """The point of a row, with its contacts."""
    numbers = numbers.copy()
    lk.set_phase(row[lk.T_PHASE], command, numbers)
    values = row.tolist()
    ax, ay, az, x, y, z = values[lk.T_COORDINATES : lk.T_COORDINATES + ck.COORDINATES]
    place_x, place_y, place_z = numbers[ck.D_PLACE : ck.D_PLACE + 3].tolist()
    pose = values[lk.T_POSE : lk.T_POSE + 12]
    return AssemblyPoint(
        math.degrees(values[lk.T_PHASE]),
        HELD[int(values[lk.T_KIND])],
        StagePose((_vector(pose, 0), _vector(pose, 3), _vector(pose, 6)), _vector(pose, 9)),
        (x - place_x, y - place_y, z - place_z),
        (math.degrees(ax), math.degrees(ay), math.degrees(az)),
        tuple(_contact(contact) for contact in contacts[: int(values[lk.T_COUNT])].tolist()),
        values[lk.T_TORQUE],
        values[lk.T_ENERGY],
        values[lk.T_POTENTIAL],
    )


def _contact(values: list[float]) -> LoadedContact:
    normal = _vector(values, st.C_NORMAL)
    force = values[st.C_FORCE]
    return LoadedContact(
        _vector(values, st.C_POINT),
        normal,
        FEATURES[int(values[st.C_PAIR])],
        (force * normal[0], force * normal[1], force * normal[2]),
    )


def _vector(values: list[float], first: int) -> Vector:
    return values[first], values[first + 1], values[first + 2]


def turned_event(event: Floats) -> PathEvent:
    """The event of a row."""
    kind = EVENTS[int(event[lk.E_KIND])]
    phase_deg, from_deg = math.degrees(event[lk.E_PHASE]), math.degrees(event[lk.E_BEFORE])
    point = vector_of(event[lk.E_POINT : lk.E_POINT + 3])
    if kind is PathEventKind.FALL:
        drop, way, loss = (float(number) for number in event[[lk.E_DROP, lk.E_WAY, lk.E_LOSS]])
        return PathEvent(kind, phase_deg, from_deg, point=point, drop=drop, way=way, energy=loss)
    if kind in (PathEventKind.GAINED, PathEventKind.LOST, PathEventKind.MOVED):
        before, after = (_features(event[i]) for i in (lk.E_OLD_PAIR, lk.E_PAIR))
        return PathEvent(kind, phase_deg, from_deg, before, after, point)
    return PathEvent(kind, phase_deg, from_deg)


def _features(index: float) -> FeaturePair | None:
    return FEATURES[int(index)] if index >= 0.0 else None
