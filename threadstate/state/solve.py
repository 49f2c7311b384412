"""Contact states of poses by the exact method."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.contact.level import solve_level
from threadstate.errors import InvalidValueError, UnresolvedPoseError
from threadstate.state.classify import classify
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, StagePose
from threadstate.state.options import TILT_LIMIT_DEG, SolveOptions
from threadstate.thread.outline import outline_is_convex
from threadstate.thread.pair import Pair
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS

__all__ = ["SolveOptions", "solve_pose", "solve_poses"]

LEVEL_TILT_DEG = 1e-9
"""Below this roll and pitch a pose is level: its contact is a patch to the last digits of a double."""

_PAIRS = tuple(FeaturePair)
_FLAGS = tuple(
    (bit, flag)
    for bit, flag in (
        (rk.FLAG_FLUSH, Flag.FLUSH),
        (rk.FLAG_TIE, Flag.TIE),
        (rk.FLAG_BALANCED, Flag.BALANCED),
        (rk.FLAG_GRAZING, Flag.GRAZING),
        (rk.FLAG_NO_SECOND, Flag.NO_SECOND),
        (rk.FLAG_NO_THIRD, Flag.NO_THIRD),
    )
)


def solve_pose(
    pair: Pair, roll_deg: float, pitch_deg: float, phase_deg: float, options: SolveOptions | None = None
) -> ContactState:
    """The contact state of one pose, its angles in degrees; as :func:`solve_poses` of this pose alone.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
        UnresolvedPoseError: the search could not close all its cells.
    """
    return solve_poses(pair, [(roll_deg, pitch_deg, phase_deg)], options)[0]


def solve_poses(pair: Pair, poses: ArrayLike, options: SolveOptions | None = None) -> list[ContactState]:
    """The contact states of poses of shape (n, 3): roll, pitch and phase in degrees, in their order.

    Lengths are in the pair's unit, frames as in the method's section 2. The same pose gives the same bits whatever
    the others are.

    Raises:
        InvalidValueError: poses not of shape (n, 3), a value not finite, roll or pitch beyond 10 deg.
        UnresolvedPoseError: the search could not close all its cells; no state is better than a guessed one.
    """
    options = options or SolveOptions()
    wanted = _checked(poses)
    rows = np.empty((len(wanted), rk.RECORD_SIZE))
    level = (np.abs(wanted[:, 0]) < LEVEL_TILT_DEG) & (np.abs(wanted[:, 1]) < LEVEL_TILT_DEG)
    tilted = np.flatnonzero(~level)
    if len(tilted):
        found = np.empty((len(tilted), rk.RECORD_SIZE))
        radians = wanted[tilted] * (math.pi / 180.0)
        sk.solve_rows(radians, _packed(pair, options), pair.bolt.row, pair.nut.row, found)
        rows[tilted] = found
    for i in np.flatnonzero(level):
        solve_level(pair, math.radians(wanted[i, 2]), rows[i])
    return [_state(pair, options, pose, row) for pose, row in zip(wanted.tolist(), rows.tolist(), strict=True)]


def _checked(poses: ArrayLike) -> NDArray[np.float64]:
    wanted = np.array(poses, dtype=np.float64, ndmin=2)
    if wanted.size == 0:
        return wanted.reshape(0, 3)
    if wanted.ndim != 2 or wanted.shape[1] != 3:
        raise InvalidValueError("poses", wanted.shape, "an array of shape (n, 3): roll, pitch, phase in deg")
    for column, name in enumerate(("roll", "pitch")):
        bad = ~(np.abs(wanted[:, column]) <= TILT_LIMIT_DEG)
        if bad.any():
            value = float(wanted[np.flatnonzero(bad)[0], column])
            raise InvalidValueError(name, value, f"{-TILT_LIMIT_DEG:g} to {TILT_LIMIT_DEG:g} deg")
    bad = ~np.isfinite(wanted[:, 2])
    if bad.any():
        raise InvalidValueError("phase", float(wanted[np.flatnonzero(bad)[0], 2]), "a finite angle in deg")
    return wanted


@lru_cache(maxsize=64)
def _packed(pair: Pair, options: SolveOptions) -> NDArray[np.float64]:
    convex = outline_is_convex(pair.bolt) and outline_is_convex(pair.nut)
    packed = np.zeros(4)
    packed[sk.S_TURN_LIMIT] = math.radians(options.turn_limit_deg)
    packed[sk.S_TIE] = options.tie_tolerance * pair.thread_pitch
    packed[sk.S_CONVEX] = float(convex)
    packed.setflags(write=False)
    return packed


def _state(pair: Pair, options: SolveOptions, pose: list[float], row: list[float]) -> ContactState:
    if row[rk.O_STATUS] != 0.0:
        raise UnresolvedPoseError(*pose)
    bits = int(row[rk.O_FLAGS])
    flags = tuple(flag for bit, flag in _FLAGS if bits & bit)
    drop, embedment, pivot_offset = (_present(row[i]) for i in (rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT))
    lambda_rad, mu_rad = _present(row[rk.O_LAMBDA]), _present(row[rk.O_MU])
    verdict = classify(
        flush=Flag.FLUSH in flags,
        third=mu_rad is not None,
        drop=drop,
        embedment=embedment,
        pivot_offset=pivot_offset,
        pivot_threshold=options.quasi_stable_fraction * pair.nominal_diameter / 2.0,
        embedment_tolerance=options.embedment_tolerance * pair.thread_pitch,
    )
    return ContactState(
        roll_deg=pose[0],
        pitch_deg=pose[1],
        phase_deg=pose[2],
        state_class=verdict.state_class,
        flags=flags,
        poses=tuple(_pose(row, rk.O_POSE + 12 * i) for i in range(int(row[rk.O_POSES]))),
        lambda_deg=None if lambda_rad is None else math.degrees(lambda_rad),
        mu_deg=None if mu_rad is None else math.degrees(mu_rad),
        drop=drop,
        embedment=embedment,
        pivot_offset=pivot_offset,
        drop_margin=verdict.drop_margin,
        embedment_margin=verdict.embedment_margin,
        pivot_margin=verdict.pivot_margin,
        contacts=tuple(_contact(row, rk.O_CONTACT + rk.POINT_SIZE * i) for i in range(int(row[rk.O_CONTACTS]))),
    )


def _present(value: float) -> float | None:
    return None if math.isnan(value) else value


def _pose(row: list[float], at: int) -> StagePose:
    return StagePose(
        rotation=(
            (row[at], row[at + 1], row[at + 2]),
            (row[at + 3], row[at + 4], row[at + 5]),
            (row[at + 6], row[at + 7], row[at + 8]),
        ),
        translation=(row[at + 9], row[at + 10], row[at + 11]),
    )


def _contact(row: list[float], at: int) -> Contact:
    point, bolt, normal = at + rk.P_POINT, at + rk.P_BOLT, at + rk.P_NORMAL
    return Contact(
        stage=int(row[at + rk.P_STAGE]),
        point=(row[point], row[point + 1], row[point + 2]),
        point_bolt=(row[bolt], row[bolt + 1], row[bolt + 2]),
        normal=(row[normal], row[normal + 1], row[normal + 2]),
        bolt_region=BOLT_REGIONS[int(row[at + rk.P_BOLT_REGION])],
        nut_region=NUT_REGIONS[int(row[at + rk.P_NUT_REGION])],
        features=_PAIRS[int(row[at + rk.P_PAIR])],
        bolt_margin=row[at + rk.P_BOLT_MARGIN],
        nut_margin=row[at + rk.P_NUT_MARGIN],
    )
