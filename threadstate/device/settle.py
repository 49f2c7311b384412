"""Settled states of poses: where a held bolt rests under a push that grows slowly, without friction."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _descent_kernel as descents
from threadstate.device import _gap_kernel as gk
from threadstate.device import _settle_kernel as sk
from threadstate.device._certificate_kernel import FREE
from threadstate.device._places_kernel import FINE, MAX_PLACES
from threadstate.device.branches import PlannedLeg, all_paths
from threadstate.device.command import (
    LONGEST_STEP_WITH_FRICTION_DEG,
    command_numbers,
    commanded_rotation,
    strip_numbers,
)
from threadstate.device.equilibrium import BALANCED, balance, stability
from threadstate.device.flush import flush_contacts, level_numbers, level_start
from threadstate.device.friction import FrictionPath, begin_friction, settled_with_friction
from threadstate.device.model import (
    Device,
    Fall,
    LoadedContact,
    Outcome,
    PathPoint,
    SettledFlag,
    SettledMargins,
    SettledState,
    default_device,
)
from threadstate.device.watch import PathWatch
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.flat_base import require_flat_base
from threadstate.state.model import FeaturePair, StagePose, Vector
from threadstate.state.records import LEVEL_TILT_DEG, first_heights
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

__all__ = ["settle_pose", "settle_poses"]

Floats = NDArray[np.float64]

LARGEST_FRICTION = 1.0
"""With more the cones of contacts on flanks hold any load."""

LEAST_FLANK_HALF_ANGLE_DEG = 20.0
"""Flatter flanks can meet the nut's surface away from both edges within the tilts that a device may reach."""

LEAST_FILLET = 0.01
"""Sharper corners than this part of the thread pitch are narrower than what the search of contacts samples."""

NO_FORCE = 1e-9
"""A contact with less force than this part of the push is one without force."""

FEATURES = tuple(FeaturePair)

REASONS = {
    descents.UNSETTLED: SettledFlag.UNSETTLED,
    descents.TOO_FAR: SettledFlag.UNSETTLED,
    descents.DEEP: SettledFlag.DEEP,
    descents.TILTED: SettledFlag.TILTED,
    sk.NO_FIRST_CONTACT: SettledFlag.FIRST_CONTACT,
}

NO_MARGINS = SettledMargins(None, None, None, None, None)


def settle_pose(
    pair: Pair,
    roll_deg: float,
    pitch_deg: float,
    phase_deg: float,
    device: Device | None = None,
    *,
    mu: float = 0.0,
) -> SettledState:
    """The settled state of one commanded pose, its angles in degrees; as :func:`settle_poses` of this pose alone."""
    return settle_poses(pair, [(roll_deg, pitch_deg, phase_deg)], device, mu=mu)[0]


def settle_poses(pair: Pair, poses: ArrayLike, device: Device | None = None, *, mu: float = 0.0) -> list[SettledState]:
    """The settled states of commanded poses of shape (n, 3): roll, pitch and phase in degrees, in their order.

    Forces, section 5: the bolt starts at its first contact, and the push grows from 0. The device is
    the default one of forces, section 4, unless another is given. A pose without a certain answer is ``undecided``,
    with a flag that says why. The same pose gives the same bits whatever the others are.

    Raises:
        InvalidValueError: poses not of shape (n, 3), a value not finite, roll or pitch beyond 10 deg; a friction that
            is negative or above 1; a pair whose corners are sharper or whose flanks are flatter than the search of
            contacts covers.
    """
    wanted = checked_poses(poses)
    check_friction(mu)
    check_pair(pair)
    held = (device or default_device()).in_unit(pair.unit)
    numbers = device_numbers(pair, held)
    rotations, rows = settled_rows(pair, held, numbers, wanted)
    if mu > 0.0:
        return [state_with_friction(pair, held, numbers, wanted[i], rows[0][i], mu) for i in range(len(wanted))]
    return [
        settled_state(pair, held, numbers, wanted[i], rotations[i], tuple(row[i] for row in rows))
        for i in range(len(wanted))
    ]


def settled_rows(pair: Pair, device: Device, numbers: Floats, poses_deg: Floats) -> tuple[Floats, sk.Rows]:
    """The commanded rotations of poses, shape (n, 9), and the kernels' rows of where they settle.

    ``device`` is in the pair's unit, ``numbers`` are its :func:`device_numbers`.
    """
    rotations = np.empty((len(poses_deg), 9))
    heights = np.full(len(poses_deg), math.nan)
    tips = np.zeros((len(poses_deg), 3))
    is_flush = np.zeros(len(poses_deg), dtype=bool)
    for i, (roll_deg, pitch_deg, phase_deg) in enumerate(poses_deg):
        rotations[i] = commanded_rotation(roll_deg, pitch_deg, phase_deg, device.about)
        if abs(roll_deg) < LEVEL_TILT_DEG and abs(pitch_deg) < LEVEL_TILT_DEG:
            heights[i], tips[i] = level_start(pair, phase_deg, rotations[i])
            is_flush[i] = not tips[i].any()
    tilted = np.isnan(heights)
    heights[tilted] = first_heights(pair, rotations[tilted])
    rows = new_rows(len(poses_deg))
    chosen = np.flatnonzero(~is_flush)
    part = new_rows(len(chosen))
    sk.settle_rows(
        rotations[chosen],
        heights[chosen],
        tips[chosen],
        device.push,
        numbers.copy(),
        pair.bolt.packed,
        pair.nut.packed,
        part,
    )
    for whole, some in zip(rows, part, strict=True):
        whole[chosen] = some
    rows[0][is_flush, sk.R_STATUS] = descents.FLUSH
    rows[0][is_flush, sk.R_HEIGHT] = heights[is_flush]
    return rotations, rows


def path_with_friction(
    pair: Pair,
    device: Device,
    numbers: Floats,
    pose_deg: Floats,
    result: Floats,
    mu: float,
    watch: PathWatch | None = None,
    *,
    longest_step_deg: float = LONGEST_STEP_WITH_FRICTION_DEG,
) -> FrictionPath | SettledState:
    """A bolt at its first contact, before the push grows with friction; its state where a path has no start.

    ``result`` is the kernels' of the same pose without friction: the height of its first contact is what counts.
    """
    roll_deg, pitch_deg, phase_deg = (float(angle) for angle in pose_deg)
    if result[sk.R_STATUS] == sk.NO_FIRST_CONTACT:
        outcome = Outcome.UNDECIDED
        nothing = (None, None, None, (), None, (), NO_MARGINS, ())
        return SettledState(roll_deg, pitch_deg, phase_deg, outcome, (SettledFlag.FIRST_CONTACT,), *nothing)
    command = command_numbers(device, roll_deg, pitch_deg, float(result[sk.R_HEIGHT]), longest_step_deg)
    is_level = abs(roll_deg) < LEVEL_TILT_DEG and abs(pitch_deg) < LEVEL_TILT_DEG
    tips = is_level and result[sk.R_STATUS] != descents.FLUSH
    return begin_friction(
        pair, numbers, command, strip_numbers(pair), math.radians(phase_deg), mu, watch, on_surface=tips
    )


def state_with_friction(
    pair: Pair, device: Device, numbers: Floats, pose_deg: Floats, result: Floats, mu: float
) -> SettledState:
    """The state of a pose that settles with friction: that in which every solution of the growing push ends."""
    path = path_with_friction(pair, device, numbers, pose_deg, result, mu)
    if isinstance(path, SettledState):
        return path
    followed = all_paths(path, math.radians(pose_deg[2]), [growing_push(device)])
    state = settled_with_friction(device, pose_deg, path, followed.paths[0][0].rows)
    if followed.is_whole and followed.first_ends == 1:
        return state
    return replace(
        state,
        outcome=Outcome.UNDECIDED,
        flags=(SettledFlag.AMBIGUOUS,),
        pose=None,
        shift=None,
        rotation_deg=None,
        contacts=(),
        elastic_energy=None,
        margins=NO_MARGINS,
    )


def growing_push(device: Device) -> PlannedLeg:
    """The leg in which a bolt settles."""
    return PlannedLeg(0.0, (0.0, device.push))


def check_friction(mu: float) -> None:
    """Check a coefficient of friction.

    Raises:
        InvalidValueError: it is not a number from 0 to the largest one.
    """
    if not 0.0 <= mu <= LARGEST_FRICTION:
        raise InvalidValueError("mu", mu, f"0 to {number_text(LARGEST_FRICTION)}")


def check_pair(pair: Pair) -> None:
    """Check that the search of contacts covers a pair.

    Raises:
        InvalidValueError: its flanks are too flat or its corners too sharp, or the bolt has a chamfer.
    """
    require_flat_base(pair, "settled states")
    for name in ("flank_half_angle_deg", "flank_half_angle_neg_deg"):
        half_angle = getattr(pair.form, name)
        if half_angle is not None and half_angle < LEAST_FLANK_HALF_ANGLE_DEG:
            raise InvalidValueError(
                name, half_angle, f"at least {number_text(LEAST_FLANK_HALF_ANGLE_DEG)} deg for a device"
            )
    for name in ("bolt_root_fillet", "bolt_crest_fillet", "nut_crest_fillet", "nut_root_fillet"):
        fillet = getattr(pair.form, name)
        if fillet < LEAST_FILLET:
            raise InvalidValueError(name, fillet, f"at least {number_text(LEAST_FILLET)} thread pitches for a device")


def device_numbers(pair: Pair, device: Device) -> Floats:
    """A device in the pair's unit as the kernels take it, without a command."""
    numbers = np.zeros(ck.DEVICE_SIZE)
    numbers[ck.D_CENTRE] = device.centre
    numbers[ck.D_SCALE] = pair.nominal_diameter / 2.0
    numbers[ck.D_RIGID] = float(device.twist_is_rigid)
    numbers[ck.D_FINE] = FINE
    numbers[ck.D_STIFFNESS :] = np.ravel(device.stiffness)
    return numbers


def new_rows(count: int) -> sk.Rows:
    """Rows of so many commands for the kernels."""
    return (
        np.zeros((count, sk.RESULT_SIZE)),
        np.zeros((count, ck.COORDINATES)),
        np.zeros((count, 12)),
        np.zeros((count, MAX_PLACES, gk.GAP_SIZE)),
        np.zeros((count, MAX_PLACES)),
        np.zeros((count, sk.MAX_FALLS, sk.FALL_SIZE)),
        np.zeros((count, sk.MAX_PATH, sk.PATH_SIZE)),
    )


def settled_state(
    pair: Pair,
    device: Device,
    numbers: Floats,
    pose_deg: Floats,
    command: Floats,
    row: tuple[Floats, ...],
) -> SettledState:
    """The state of a pose from its row."""
    result, end, placement, places, multipliers, falls, path = row
    roll_deg, pitch_deg, phase_deg = (float(angle) for angle in pose_deg)
    numbers = numbers.copy()
    sk.set_command(command, result[sk.R_HEIGHT], numbers, np.empty(ck.COORDINATES))
    fallen = tuple(_fall(fall, numbers) for fall in falls[: int(result[sk.R_FALLS])])
    points = tuple(_point(point) for point in path[: int(result[sk.R_PATH])])

    def undecided(*flags: SettledFlag, outcome: Outcome = Outcome.UNDECIDED) -> SettledState:
        return SettledState(
            roll_deg, pitch_deg, phase_deg, outcome, flags, None, None, None, (), None, fallen, NO_MARGINS, points
        )

    def settled(
        q: Floats,
        pose: Floats,
        contacts: tuple[LoadedContact, ...],
        flags: tuple[SettledFlag, ...],
        margins: SettledMargins,
    ) -> SettledState:
        shift = q[3:] - numbers[ck.D_PLACE : ck.D_PLACE + 3]
        energy = ck.elastic_energy(q, numbers, np.empty(ck.COORDINATES))
        matrix = pose[:9].reshape(3, 3)
        placed = StagePose(tuple(vector_of(line) for line in matrix), vector_of(pose[9:]))  # type: ignore[arg-type]
        return SettledState(
            roll_deg,
            pitch_deg,
            phase_deg,
            Outcome.SETTLED,
            flags,
            placed,
            vector_of(shift),
            vector_of(np.degrees(q[:3])),
            contacts,
            float(energy),
            fallen,
            margins,
            points,
        )

    status = int(result[sk.R_STATUS])
    if status == descents.FLUSH:
        q, pose = level_numbers(numbers)
        contacts, pressure, residual = flush_contacts(pair, device, numbers, q, pose)
        if pressure is None or not pressure > 0.0:
            return undecided(SettledFlag.FLUSH, SettledFlag.UNSTABLE)
        if not residual <= BALANCED:
            return undecided(SettledFlag.FLUSH, SettledFlag.UNBALANCED)
        return settled(q, pose, contacts, (SettledFlag.FLUSH,), SettledMargins(None, None, None, residual, pressure))
    if status == descents.SLIPPED:
        return undecided(outcome=Outcome.SLIPPED)
    if status != descents.AT_REST:
        return undecided(REASONS[status])
    if int(result[sk.R_OVERLAP]) != FREE:
        return undecided(SettledFlag.OVERLAP)
    count = int(result[sk.R_PLACES])
    places, multipliers = places[:count], multipliers[:count]
    loaded = multipliers * places[:, gk.G_NORM] > NO_FORCE * device.push
    contacts = tuple(
        LoadedContact(
            vector_of(place[gk.G_POINT : gk.G_POINT + 3]),
            vector_of(place[gk.G_NORMAL : gk.G_NORMAL + 3]),
            FEATURES[int(place[gk.G_PAIR])],
            vector_of(multiplier * place[gk.G_NORM] * place[gk.G_NORMAL : gk.G_NORMAL + 3]),
        )
        for place, multiplier in zip(places[loaded], multipliers[loaded], strict=True)
    )
    residual = balance(pair, device, end, placement, numbers, contacts)
    if not residual <= BALANCED:
        return undecided(SettledFlag.UNBALANCED)
    curvature = stability(pair, end, numbers, places[loaded], multipliers[loaded])
    if curvature is not None and not curvature > 0.0:
        return undecided(SettledFlag.UNSTABLE)
    gaps = -places[~loaded, gk.G_VALUE] / places[~loaded, gk.G_NORM]
    gap = float(gaps.min()) if len(gaps) else None
    force = float((multipliers[loaded] * places[loaded, gk.G_NORM]).min()) / device.push if loaded.any() else None
    is_marginal = gap is not None and gap <= sk.LEAST_GAP * pair.nominal_diameter
    return settled(
        end,
        placement,
        contacts,
        (SettledFlag.MARGINAL,) if is_marginal else (),
        SettledMargins(force, gap, curvature, residual, None),
    )


def _fall(fall: Floats, numbers: Floats) -> Fall:
    before, after = np.empty(ck.PLACE_SIZE), np.empty(ck.PLACE_SIZE)
    ck.set_place(fall[sk.F_BEFORE : sk.F_BEFORE + 6], numbers, before)
    ck.set_place(fall[sk.F_AFTER : sk.F_AFTER + 6], numbers, after)
    way = before[ck.N_OFFSET : ck.N_OFFSET + 3] - after[ck.N_OFFSET : ck.N_OFFSET + 3]
    return Fall(
        float(fall[sk.F_PUSH]),
        float(way[2]),
        float(np.linalg.norm(way)),
        float(fall[sk.F_POTENTIAL] - fall[sk.F_POTENTIAL + 1]),
    )


def _point(point: Floats) -> PathPoint:
    return PathPoint(
        float(point[sk.P_PUSH]),
        float(point[sk.P_ENERGY]),
        float(point[sk.P_POTENTIAL]),
        vector_of(point[sk.P_COORDINATES : sk.P_COORDINATES + 3]),
        vector_of(point[sk.P_COORDINATES + 3 : sk.P_COORDINATES + 6]),
    )


def vector_of(numbers: Floats) -> Vector:
    """Three numbers as a vector."""
    x, y, z = numbers.tolist()
    return x, y, z
