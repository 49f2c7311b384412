"""Held bolts with friction: how the kernels' paths become settled states and points of paths (forces, section 5)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _leg_kernel as lk
from threadstate.device import _modes_kernel as mk
from threadstate.device._certificate_kernel import FREE
from threadstate.device._friction_fall_kernel import FRICTIONLESS
from threadstate.device.assembly_model import AssemblyPoint, ContactMotion, Held, PathEvent, PathEventKind
from threadstate.device.equilibrium import BALANCED, balance
from threadstate.device.flush import patch_hull
from threadstate.device.model import (
    Device,
    Fall,
    LoadedContact,
    Outcome,
    PathPoint,
    SettledFlag,
    SettledMargins,
    SettledState,
)
from threadstate.device.watch import PathWatch
from threadstate.state.model import FeaturePair, StagePose, Vector
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

FEATURES = tuple(FeaturePair)

ROOM = 8
"""Contacts that a point has room for: those of a strip."""

HELD = (Held.CONTACTS, Held.SURFACE, Held.STRIP)

LAID = {Held.SURFACE: PathEventKind.ON_SURFACE, Held.STRIP: PathEventKind.ON_STRIP}

MOTIONS = {mk.SLIPS: ContactMotion.SLIDES, mk.STICKS: ContactMotion.STICKS}

REASONS = {
    fs.TOO_DEEP: SettledFlag.DEEP,
    fs.TOO_MANY: SettledFlag.MANY_CONTACTS,
    fs.ON_PATCH: SettledFlag.FLUSH,
    fs.PATH_FULL: SettledFlag.UNSETTLED,
    fs.NO_MINIMUM: SettledFlag.UNSETTLED,
}
"""Why a path with friction has no certain end. A bolt that a strip of flank does not hold any more is not followed with
friction, nor one that a device whose twist is not rigid lays flush on the surface."""


@dataclass(frozen=True)
class FrictionBranch:
    """Another solution of a step: the leg up to the point that it sets, as the kernels' rows."""

    points: Floats
    contacts: Floats


@dataclass(frozen=True)
class FrictionLeg:
    """A part of a path with friction: how it ended, its points, and their contacts, as the kernels' rows.

    ``branches`` are those of the points that were followed last; with ``has_more`` there were more.
    """

    status: int
    points: Floats
    contacts: Floats
    branches: tuple[FrictionBranch, ...]
    has_more: bool


@dataclass(frozen=True)
class RunningFrictionLeg:
    """A leg with friction, as :func:`threadstate.device._friction_kernel.follow_friction` sets its points."""

    points: Floats
    command: Floats

    def reached(self) -> tuple[int, float | None]:
        """How many points it has, and the phase of the last one in degrees.

        The last row set is a step that may yet be taken back. A leg in which the push grows begins without any.
        """
        count = max(int(np.count_nonzero(self.points[:, fk.P_PUSH])) - 1, 0)
        return count, math.degrees(self.points[count - 1, fk.P_PHASE]) if count else None

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """None: what happens between points is seen when all are there."""
        _ = phase_deg
        return []

    def stop(self) -> None:
        """Have the kernel end it, as beyond the torque at which the bolt jams: no torque is below a negative limit."""
        self.command[lk.M_PUSH] = -1.0


@dataclass
class FrictionPath:
    """A bolt that is followed leg by leg: its coordinates and contacts at the end of the last one."""

    pair: Pair
    numbers: Floats
    command: Floats
    strip: Floats
    mu: float
    q: Floats
    count: int
    contacts: Floats
    watch: PathWatch

    def follow(
        self,
        phases: tuple[float, float],
        pushes: tuple[float, float],
        *,
        stops_at_snap: bool = False,
        begun: FrictionBranch | None = None,
    ) -> FrictionLeg:
        """Follows it while phase (rad) and push (N) go from the first to the second; a leg that has begun, to its end.

        Raises:
            PathStoppedError: the path was stopped.
        """
        points = np.zeros((fk.MAX_POINTS, fk.POINT_SIZE))
        contacts = np.zeros((fk.MAX_POINTS, ROOM, mk.CONTACT_SIZE))
        first = 0
        if begun is not None:
            first = len(begun.points)
            points[:first], contacts[:first] = begun.points, begun.contacts
        rows = np.zeros((fk.MAX_BRANCHES, fk.POINT_SIZE))
        row_contacts = np.zeros((fk.MAX_BRANCHES, ROOM, mk.CONTACT_SIZE))
        indices = np.full(fk.MAX_BRANCHES, -1)
        self.watch.begin_leg(RunningFrictionLeg(points, self.command))
        status, length, self.count = fk.follow_friction(
            self.q,
            np.array(phases),
            np.array(pushes),
            self.mu,
            stops_at_snap,
            self.count,
            self.contacts,
            self.command,
            self.numbers,
            self.strip,
            self.pair.bolt.packed,
            self.pair.nut.packed,
            first,
            (points, contacts),
            (rows, row_contacts, indices),
        )
        self.watch.end_leg()
        branches = tuple(
            FrictionBranch(np.vstack([points[:i], row[None]]), np.concatenate([contacts[:i], of_row[None]]))
            for i, row, of_row in zip(indices, rows, row_contacts, strict=True)
            if i >= 0
        )
        has_more = int((points[first:length, fk.P_SOLUTIONS] - 1.0).clip(0.0).sum()) > len(branches)
        return FrictionLeg(status, points[:length], contacts[:length], branches, has_more)

    def copy(self) -> FrictionPath:
        """The same bolt, to be followed apart."""
        return replace(self, q=self.q.copy(), contacts=self.contacts.copy(), numbers=self.numbers.copy())

    def is_free(self, row: Floats) -> bool:
        """Whether overlaps are excluded where the bolt is at a point, given as its row."""
        numbers = self.numbers.copy()
        lk.set_phase(row[fk.P_PHASE], self.command, numbers)
        q = row[fk.P_COORDINATES : fk.P_COORDINATES + ck.COORDINATES].copy()
        return int(fk.certified_pose(q, numbers, self.pair.bolt.packed, self.pair.nut.packed)) == FREE


def begin_friction(
    pair: Pair,
    numbers: Floats,
    command: Floats,
    strip: Floats,
    phase: float,
    mu: float,
    watch: PathWatch | None = None,
    *,
    on_surface: bool = False,
) -> FrictionPath:
    """A bolt at its first contact, before the push grows; ``phase`` in rad.

    One that is level and does not stay so has its contact ``on_surface``: its first step tips it.
    """
    numbers = numbers.copy()
    lk.set_phase(phase, command, numbers)
    q = np.zeros(ck.COORDINATES)
    q[3:] = numbers[ck.D_PLACE : ck.D_PLACE + 3]
    contacts = np.zeros((ROOM, mk.CONTACT_SIZE))
    if on_surface:
        contacts[0, mk.K_NORMAL + 2] = 1.0
        contacts[0, mk.K_MODE], contacts[0, mk.K_PAIR] = mk.STICKS, FLUSH_PAIR
    return FrictionPath(pair, numbers, command, strip, mu, q, int(on_surface), contacts, watch or PathWatch())


def point_of(row: Floats, contacts: Floats, numbers: Floats, command: Floats) -> AssemblyPoint:
    """A point of a path from its row."""
    numbers = numbers.copy()
    lk.set_phase(row[fk.P_PHASE], command, numbers)
    q = row[fk.P_COORDINATES : fk.P_COORDINATES + ck.COORDINATES]
    pose = row[fk.P_POSE : fk.P_POSE + 12]
    found = contacts[: int(row[fk.P_COUNT])]
    return AssemblyPoint(
        math.degrees(row[fk.P_PHASE]),
        HELD[int(row[fk.P_KIND])],
        StagePose(tuple(_vector(line) for line in pose[:9].reshape(3, 3)), _vector(pose[9:])),  # type: ignore[arg-type]
        _vector(q[3:] - numbers[ck.D_PLACE : ck.D_PLACE + 3]),
        _vector(np.degrees(q[:3])),
        tuple(contact_of(contact) for contact in found),
        float(row[fk.P_TORQUE]),
        float(row[fk.P_ENERGY]),
        float(row[fk.P_POTENTIAL]),
        tuple(MOTIONS[int(contact[mk.K_MODE])] for contact in found),
        max(int(row[fk.P_SOLUTIONS]), 0),
    )


def friction_events(points: Sequence[AssemblyPoint], rows: Floats) -> list[PathEvent]:
    """What happens between the points of a leg: falls, contacts by their features, and steps of several solutions."""
    events = []
    for i in range(1, len(points)):
        before, after = points[i - 1], points[i]
        phases = (after.phase_deg, before.phase_deg)
        if rows[i, fk.P_FALL] > 0.0:
            drop = before.pose.translation[2] - after.pose.translation[2]
            way = math.dist(before.pose.translation, after.pose.translation)
            energy = float(rows[i, fk.P_FALL])
            events.append(PathEvent(PathEventKind.FALL, *phases, drop=drop, way=way, energy=energy))
        if rows[i, fk.P_SOLUTIONS] == FRICTIONLESS:
            events.append(PathEvent(PathEventKind.FRICTIONLESS_FALL, *phases))
        if after.solutions > 1:
            events.append(PathEvent(PathEventKind.AMBIGUOUS, *phases))
        if after.held is not before.held:
            if before.held is Held.SURFACE:
                events.append(PathEvent(PathEventKind.OFF_SURFACE, *phases))
            if after.held is not Held.CONTACTS:
                events.append(PathEvent(LAID[after.held], *phases))
                continue
        left = [contact.features for contact in before.contacts]
        for contact in after.contacts if after.held is Held.CONTACTS else ():
            if contact.features in left:
                left.remove(contact.features)
            else:
                events.append(PathEvent(PathEventKind.GAINED, *phases, None, contact.features, contact.point))
        if after.held is Held.CONTACTS:
            events += [PathEvent(PathEventKind.LOST, *phases, features) for features in left]
    return events


def snap_event(points: Sequence[AssemblyPoint]) -> PathEvent:
    """The snap at the last point of a leg: the descent within its span of phase."""
    span = math.degrees(lk.SNAP_SPAN) * (1.0 + 1e-9)
    last = points[-1]
    near = [point for point in points if abs(last.phase_deg - point.phase_deg) <= span]
    highest = max(near, key=lambda point: point.pose.translation[2])
    drop = highest.pose.translation[2] - last.pose.translation[2]
    way = math.dist(highest.pose.translation, last.pose.translation)
    return PathEvent(PathEventKind.SNAP, last.phase_deg, highest.phase_deg, drop=drop, way=way)


def contact_of(contact: Floats) -> LoadedContact:
    """A contact with its whole force from its row."""
    return LoadedContact(
        _vector(contact[mk.K_POINT : mk.K_POINT + 3]),
        _vector(contact[mk.K_NORMAL : mk.K_NORMAL + 3]),
        FEATURES[int(contact[mk.K_PAIR])],
        _vector(contact[mk.K_FORCE : mk.K_FORCE + 3]),
    )


def settled_with_friction(device: Device, pose_deg: Floats, path: FrictionPath, leg: FrictionLeg) -> SettledState:
    """The state that a growing push reaches with friction, ``leg``; ``path`` is the bolt that was followed."""
    roll_deg, pitch_deg, phase_deg = (float(angle) for angle in pose_deg)
    points = tuple(
        PathPoint(
            float(row[fk.P_PUSH]),
            float(row[fk.P_ENERGY]),
            float(row[fk.P_POTENTIAL]),
            _vector(row[fk.P_COORDINATES : fk.P_COORDINATES + 3]),
            _vector(row[fk.P_COORDINATES + 3 : fk.P_COORDINATES + 6]),
        )
        for row in leg.points
    )
    falls = tuple(_fall(leg.points, i) for i in range(1, len(leg.points)) if leg.points[i, fk.P_FALL] > 0.0)
    last = point_of(leg.points[-1], leg.contacts[-1], path.numbers, path.command)
    numbers = path.numbers.copy()
    lk.set_phase(leg.points[-1, fk.P_PHASE], path.command, numbers)
    q = leg.points[-1, fk.P_COORDINATES : fk.P_COORDINATES + ck.COORDINATES].copy()
    residual = None
    flags: tuple[SettledFlag, ...] = ()
    outcome = Outcome.UNDECIDED
    if leg.status == fs.SLIPPED_OFF:
        outcome = Outcome.SLIPPED
    elif leg.status != fs.REACHED:
        flags = (REASONS[leg.status],)
    elif last.held is Held.CONTACTS and not path.is_free(leg.points[-1]):
        flags = (SettledFlag.OVERLAP,)
    else:
        pose = leg.points[-1, fk.P_POSE : fk.P_POSE + 12]
        residual = balance(path.pair, device, q, pose, numbers, last.contacts)
        outcome = Outcome.SETTLED if residual <= BALANCED else Outcome.UNDECIDED
        flags = (SettledFlag.FLUSH,) if last.held is Held.SURFACE else ()
        flags += () if residual <= BALANCED else (SettledFlag.UNBALANCED,)
        flags += (SettledFlag.FRICTIONLESS_FALL,) if (leg.points[:, fk.P_SOLUTIONS] == FRICTIONLESS).any() else ()
    is_settled = outcome is Outcome.SETTLED
    pressure = None
    if is_settled and last.held is Held.SURFACE:
        place = np.empty(ck.PLACE_SIZE)
        ck.set_place(q, numbers, place)
        _, _, pressure, _ = patch_hull(path.pair, place, *last.contacts[0].point[:2])
    least = min((math.hypot(*contact.force) for contact in last.contacts), default=None)
    force = least / device.push if is_settled and least is not None else None
    return SettledState(
        roll_deg,
        pitch_deg,
        phase_deg,
        outcome,
        flags,
        last.pose if is_settled else None,
        last.shift if is_settled else None,
        last.rotation_deg if is_settled else None,
        last.contacts if is_settled else (),
        last.elastic_energy if is_settled else None,
        falls,
        SettledMargins(force, None, None, residual, pressure),
        points,
    )


def _fall(rows: Floats, i: int) -> Fall:
    way = rows[i - 1, fk.P_POSE + 9 : fk.P_POSE + 12] - rows[i, fk.P_POSE + 9 : fk.P_POSE + 12]
    return Fall(float(rows[i, fk.P_PUSH]), float(way[2]), float(np.linalg.norm(way)), float(rows[i, fk.P_FALL]))


def _vector(numbers: Floats) -> Vector:
    x, y, z = numbers.tolist()
    return x, y, z
