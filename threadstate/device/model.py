"""A device that holds the bolt, and where a bolt that it holds comes to rest: frozen values (docs/device.md)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.model import FeaturePair, StagePose, Vector
from threadstate.units import LengthUnit, conversion_factor

Stiffness = tuple[tuple[float, ...], ...]

LARGEST_NUMBER = 1e12
"""Of a stiffness, a push or a length: what is larger overflows where they are multiplied."""
ANY_NUMBER = f"-{number_text(LARGEST_NUMBER)} to {number_text(LARGEST_NUMBER)}"

WHOLE_TURN_DEG = 360.0
LEAST_CCW_TURN_DEG, LARGEST_CCW_TURN_DEG = 1.0, 450.0
"""From a whole turn on the command is what it was: beyond it the bolt only finds a snap that comes late."""

LEAST_EIGENVALUE = -1e-9
"""Of a stiffness with ones on its diagonal: what is above it is round-off of zero."""

TWIST = 2
"""The row of the twist in a stiffness."""


class About(StrEnum):
    """What a device turns the bolt about as the phase grows (forces, section 4)."""

    NUT = "nut"
    """The nut's axis: R_cmd = Rz(phase) Ry Rx."""
    BOLT = "bolt"
    """Its own axis: R_cmd = Ry Rx Rz(phase)."""


@dataclass(frozen=True)
class Limits:
    """The largest tilt (deg), shift (a length) and torque (N times its unit) that a device allows; None: any.

    Raises:
        InvalidValueError: one of them is not positive.
    """

    tilt_deg: float | None = None
    shift: float | None = None
    torque: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("tilt", self.tilt_deg), ("shift", self.shift), ("torque", self.torque)):
            if value is not None and not 0.0 < value <= LARGEST_NUMBER:
                raise InvalidValueError(f"{name}_limit", value, f"a number > 0, up to {number_text(LARGEST_NUMBER)}")

    def allow_travel(self, tilt_deg: float, shift: float) -> bool:
        """Whether the device can give way as far."""
        return is_up_to(tilt_deg, self.tilt_deg) and is_up_to(shift, self.shift)

    def allow_torque(self, torque: float) -> bool:
        """Whether the hand can hold a torque."""
        return is_up_to(torque, self.torque)

    def in_unit(self, factor: float) -> Limits:
        """The same limits where a length is ``factor`` times as large a number."""
        shift, torque = (None if value is None else value * factor for value in (self.shift, self.torque))
        return Limits(self.tilt_deg, shift, torque)


def is_up_to(value: float, limit: float | None) -> bool:
    """Whether a value is not above a limit; None: any."""
    return limit is None or value <= limit


NO_LIMITS = Limits()


@dataclass(frozen=True)
class Device:
    """A compliant hand (forces, section 4): lengths in ``unit``, forces in N, angles in rad.

    ``stiffness`` is 6 x 6 by rows: the rotation vector of the deviation, in the commanded bolt's axes, then the shift
    of the compliance centre, in the nut's axes. ``centre`` is the height of the compliance centre over the bolt's base.
    With ``twist_is_rigid`` the third component of the rotation vector is zero, and so are its row and column.
    ``ccw_turn_deg`` is how far the hand turns counter-clockwise at most, until the snap; of a left-hand bolt clockwise.
    A path ends where it passes one of the ``limits``.

    Raises:
        InvalidValueError: a number is not finite, the push is not positive, the stiffness is not 6 x 6, not
            symmetric or indefinite, or the turn is not of 1 to 450 deg.
    """

    stiffness: Stiffness
    centre: float
    push: float
    unit: LengthUnit
    twist_is_rigid: bool = True
    about: About = About.NUT
    ccw_turn_deg: float = WHOLE_TURN_DEG
    limits: Limits = NO_LIMITS

    def __post_init__(self) -> None:
        if not abs(self.centre) <= LARGEST_NUMBER:
            raise InvalidValueError("centre", self.centre, f"a length, {ANY_NUMBER}")
        if not 0.0 < self.push <= LARGEST_NUMBER:
            raise InvalidValueError("push", self.push, f"a force > 0 in N, up to {number_text(LARGEST_NUMBER)}")
        if not LEAST_CCW_TURN_DEG <= self.ccw_turn_deg <= LARGEST_CCW_TURN_DEG:
            valid = f"{number_text(LEAST_CCW_TURN_DEG)} to {number_text(LARGEST_CCW_TURN_DEG)} deg"
            raise InvalidValueError("ccw_turn", self.ccw_turn_deg, valid)
        object.__setattr__(self, "stiffness", _checked_stiffness(self.stiffness, rigid=self.twist_is_rigid))

    def in_unit(self, unit: LengthUnit) -> Device:
        """The same device with its lengths in ``unit``."""
        factor = conversion_factor(self.unit, unit)
        powers = [1 if i < 3 else 0 for i in range(6)]
        stiffness = tuple(
            tuple(value * factor ** (powers[i] + powers[j] - 1) for j, value in enumerate(row))
            for i, row in enumerate(self.stiffness)
        )
        limits = self.limits.in_unit(factor)
        return replace(self, stiffness=stiffness, centre=self.centre * factor, unit=unit, limits=limits)


def diagonal_device(
    *,
    k_lateral: float,
    k_axial: float,
    k_tilt: float,
    k_twist: float | None,
    centre: float,
    push: float,
    unit: LengthUnit,
    about: About = About.NUT,
    ccw_turn_deg: float = WHOLE_TURN_DEG,
    limits: Limits = NO_LIMITS,
) -> Device:
    """The device of four stiffnesses; ``k_twist`` None: rigid. Units and errors as of :class:`Device`.

    Raises:
        InvalidValueError: a stiffness is negative, or anything that :class:`Device` refuses.
    """
    for name, value in (("k_lateral", k_lateral), ("k_axial", k_axial), ("k_tilt", k_tilt), ("k_twist", k_twist)):
        if value is not None and not 0.0 <= value <= LARGEST_NUMBER:
            rigid = ', or "rigid"' if name == "k_twist" else ""
            raise InvalidValueError(name, value, f"a stiffness >= 0, up to {number_text(LARGEST_NUMBER)}{rigid}")
    diagonal = (k_tilt, k_tilt, k_twist or 0.0, k_lateral, k_lateral, k_axial)
    stiffness = tuple(tuple(value if i == j else 0.0 for j in range(6)) for i, value in enumerate(diagonal))
    return Device(stiffness, centre, push, unit, k_twist is None, about, ccw_turn_deg, limits)


def default_device() -> Device:
    """The device that is meant where none is named (forces, section 4): declared, not measured."""
    return diagonal_device(
        k_lateral=20.0,
        k_axial=0.0,
        k_tilt=500.0,
        k_twist=None,
        centre=0.0,
        push=10.0,
        unit=LengthUnit.MILLIMETRE,
    )


def _checked_stiffness(stiffness: Sequence[Sequence[float]], *, rigid: bool) -> Stiffness:
    rows = tuple(tuple(float(value) for value in row) for row in stiffness)
    if len(rows) != 6 or any(len(row) != 6 for row in rows):
        raise InvalidValueError("stiffness", [len(row) for row in rows], "6 rows of 6 numbers")
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            if not abs(value) <= LARGEST_NUMBER:
                raise InvalidValueError(
                    f"stiffness[{i}][{j}]",
                    value,
                    f"a finite number, {ANY_NUMBER}",
                )
            if rigid and value != 0.0 and TWIST in (i, j):
                raise InvalidValueError(f"stiffness[{i}][{j}]", value, "0 where the twist is rigid")
    for i in range(6):
        if rows[i][i] < 0.0:
            raise InvalidValueError(
                f"stiffness[{i}][{i}]", rows[i][i], "a number >= 0: the matrix is positive semidefinite"
            )
    roots = [math.sqrt(rows[i][i]) for i in range(6)]
    for i in range(6):
        for j in range(i):
            size = roots[i] * roots[j]
            if abs(rows[i][j] - rows[j][i]) > 1e-12 * max(abs(rows[i][j]), abs(rows[j][i])):
                raise InvalidValueError(
                    f"stiffness[{i}][{j}]", rows[i][j], f"{rows[j][i]!r} as its transpose: symmetric"
                )
            if size == 0.0 and rows[i][j] != 0.0:
                raise InvalidValueError(
                    f"stiffness[{i}][{j}]",
                    rows[i][j],
                    "0 beside a zero of the diagonal: the matrix is positive semidefinite",
                )
    # Imported late: clients, which have no numpy, know the names of this module.
    import numpy as np

    scaled = np.array([[rows[i][j] / (roots[i] * roots[j] or 1.0) for j in range(6)] for i in range(6)])
    least = float(np.linalg.eigvalsh(scaled)[0])
    if least < LEAST_EIGENVALUE:
        raise InvalidValueError(
            "stiffness", f"least eigenvalue {least:.3g} with ones on the diagonal", "a positive semidefinite matrix"
        )
    return rows


class Outcome(StrEnum):
    """How a push ends."""

    SETTLED = "settled"
    """The bolt rests at a certified minimum."""
    SLIPPED = "slipped"
    """The bolt has left the nut sideways by more than half its major diameter."""
    UNDECIDED = "undecided"
    """No certain answer; a flag says why."""


class SettledFlag(StrEnum):
    """A named special case of a settled state, or the reason why there is none."""

    AMBIGUOUS = "ambiguous"
    """With friction a step had several solutions, which end apart; of the start of a path: it is one of several."""
    FLUSH = "flush"
    """The base lies flush on the nut's surface; the contacts are extreme points of the patch that balance the push."""
    MARGINAL = "marginal"
    """A contact without force, or a place that touches without being needed: the least change ends this state."""
    DEEP = "deep"
    """The bolt went deeper into the nut than its thread is searched, 3.6 thread pitches."""
    FIRST_CONTACT = "first_contact"
    """The search for the first contact could not exclude all its boxes."""
    FRICTIONLESS_FALL = "frictionless_fall"
    """With friction no step of a fall went on: the bolt fell there as one without friction."""
    MANY_CONTACTS = "many_contacts"
    """With friction, more contacts than have their modes enumerated."""
    OVERLAP = "overlap"
    """An overlap at the end could not be excluded."""
    STEP_DEPENDENT = "step_dependent"
    """Of a success map's path beside a boundary, or that others would go on as: with half the step it ends otherwise.
    Of a path without friction: a fall ends elsewhere in shorter steps, or the potential rises unexplained.
    """
    TILTED = "tilted"
    """The bolt tilted by more than the flank's half-angle, where its thread can meet the nut's surface."""
    UNBALANCED = "unbalanced"
    """The contact forces found do not balance device and push."""
    UNSETTLED = "unsettled"
    """The descent did not end within its steps."""
    UNSTABLE = "unstable"
    """The equilibrium found is not a minimum."""


@dataclass(frozen=True, slots=True)
class LoadedContact:
    """A contact that carries a force: the force on the bolt in N; point, unit normal and force in the nut's frame.

    The point is a length in the pair's unit. The normal points from the nut into the bolt.
    """

    point: Vector
    normal: Vector
    features: FeaturePair
    force: Vector


@dataclass(frozen=True, slots=True)
class Fall:
    """Where the minimum that the bolt followed ceased to be one: the push (N), and what the fall changed.

    ``drop`` is how far the bolt's origin sank and ``way`` how far it went, both lengths; ``energy`` is the potential
    lost, in N times the pair's unit.
    """

    push: float
    drop: float
    way: float
    energy: float


@dataclass(frozen=True, slots=True)
class SettledMargins:
    """How far a settled state is from its next event; each is positive where it is settled, None where it has none.

    ``force`` is the least contact force over the push; ``gap`` the least gap of a place that does not touch, a length;
    ``stability`` the least curvature of the potential over the feasible motions, N a length in the metric of forces,
    section 5; ``residual`` the unbalanced force over the push (moments over the nominal radius); ``pressure`` how far
    inside the patch's convex hull the centre of pressure of a flush bolt lies, a length.
    """

    force: float | None
    gap: float | None
    stability: float | None
    residual: float | None
    pressure: float | None


@dataclass(frozen=True, slots=True)
class PathPoint:
    """A point of the path on which the push grew: the push (N), energies (N times the pair's unit), the bolt's
    place.
    """

    push: float
    elastic_energy: float
    potential: float
    rotation: Vector
    centre: Vector


@dataclass(frozen=True, slots=True)
class SettledState:
    """Where a bolt comes to rest that a device holds at a commanded pose and pushes (forces, section 5).

    Lengths are in the pair's unit, forces in N. ``shift`` is that of the compliance centre from its commanded place in
    the nut's axes, its height over that at the first contact; ``rotation_deg`` is the rotation vector in the commanded
    bolt's axes. Where the outcome is not ``settled`` there are no contacts, and pose, shift, rotation and energy are
    None.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    outcome: Outcome
    flags: tuple[SettledFlag, ...]
    pose: StagePose | None
    shift: Vector | None
    rotation_deg: Vector | None
    contacts: tuple[LoadedContact, ...]
    elastic_energy: float | None
    falls: tuple[Fall, ...]
    margins: SettledMargins
    path: tuple[PathPoint, ...]
