"""A turn without friction, from the kernels' rows to points and events."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _strip_kernel as st
from threadstate.device import _turn_kernel as tk
from threadstate.device.assembly_model import AssemblyPoint, Held, PathEvent, PathEventKind
from threadstate.device.model import LoadedContact
from threadstate.device.settle import FEATURES, vector_of
from threadstate.state.model import FeaturePair, StagePose

Floats = NDArray[np.float64]

EVENTS = {
    tk.GAINED: PathEventKind.GAINED,
    tk.LOST: PathEventKind.LOST,
    tk.MOVED: PathEventKind.MOVED,
    tk.FALL: PathEventKind.FALL,
    tk.ON_FLUSH: PathEventKind.ON_SURFACE,
    tk.OFF_FLUSH: PathEventKind.OFF_SURFACE,
    tk.ON_FLANK: PathEventKind.ON_STRIP,
    tk.OFF_STRIP: PathEventKind.OFF_STRIP,
    tk.BRIDGED: PathEventKind.BRIDGED,
}

HELD = (Held.CONTACTS, Held.SURFACE, Held.STRIP)


def new_leg() -> tk.Leg:
    """The arrays of a leg for the kernels."""
    return (
        np.zeros(tk.LEG_SIZE),
        np.zeros((tk.MAX_POINTS, tk.POINT_SIZE)),
        np.zeros((tk.MAX_POINTS, st.MAX_CONTACTS, st.CONTACT_SIZE)),
        np.zeros((tk.MAX_EVENTS, tk.EVENT_SIZE)),
    )


@dataclass(frozen=True)
class RunningTurn:
    """A leg without friction, as :func:`threadstate.device._turn_kernel.turn_with` sets it."""

    leg: tk.Leg

    def reached(self) -> tuple[int, float | None]:
        """How many points it has, and the phase of the last one in degrees."""
        result, rows, _, _ = self.leg
        count = int(result[tk.L_POINTS])
        return count, math.degrees(rows[count - 1, tk.T_PHASE]) if count else None

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """The events up to a phase that it has reached: those of a step are all there once its point is."""
        result, rows, _, happened = self.leg
        if phase_deg is None:
            return []
        # The last row of a full list is overwritten.
        found = [turned_event(event) for event in happened[: min(int(result[tk.L_EVENTS]), tk.MAX_EVENTS - 1)]]
        return events_up_to(phase_deg, math.degrees(rows[0, tk.T_PHASE]), found)

    def stop(self) -> None:
        """Have the kernel end it, as after its last descent."""
        self.leg[0][tk.L_DESCENTS] = math.inf


def events_up_to(phase_deg: float, start_deg: float, events: list[PathEvent]) -> list[PathEvent]:
    """The events of a turn from a phase up to another one."""
    return [event for event in events if abs(event.phase_deg - start_deg) <= abs(phase_deg - start_deg)]


def turned_point(row: Floats, contacts: Floats, numbers: Floats, command: Floats) -> AssemblyPoint:
    """The point of a row, with its contacts."""
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


def turned_event(event: Floats) -> PathEvent:
    """The event of a row."""
    kind = EVENTS[int(event[tk.E_KIND])]
    phase_deg, from_deg = math.degrees(event[tk.E_PHASE]), math.degrees(event[tk.E_BEFORE])
    point = vector_of(event[tk.E_POINT : tk.E_POINT + 3])
    if kind is PathEventKind.FALL:
        drop, way, loss = (float(number) for number in event[[tk.E_DROP, tk.E_WAY, tk.E_LOSS]])
        return PathEvent(kind, phase_deg, from_deg, point=point, drop=drop, way=way, energy=loss)
    if kind in (PathEventKind.GAINED, PathEventKind.LOST, PathEventKind.MOVED):
        before, after = (_features(event[i]) for i in (tk.E_OLD_PAIR, tk.E_PAIR))
        return PathEvent(kind, phase_deg, from_deg, before, after, point)
    return PathEvent(kind, phase_deg, from_deg)


def _features(index: float) -> FeaturePair | None:
    return FEATURES[int(index)] if index >= 0.0 else None
