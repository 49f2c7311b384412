"""States from the kernels' records: column by column for all poses together."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.errors import SEARCH_ENDED, UnresolvedPoseError
from threadstate.state.classify import classify
from threadstate.state.model import Answer, Contact, ContactState, FeaturePair, Flag, StagePose, UndecidedPose, Vector
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from threadstate.thread.regions import NUT_REGIONS, SIDE_REGIONS

Array = NDArray[np.float64]

STAGES = 3
"""Number of poses in a record."""

FEATURES = tuple(FeaturePair)
FLAG_BITS = (
    (rk.FLAG_FLUSH, Flag.FLUSH),
    (rk.FLAG_TIE, Flag.TIE),
    (rk.FLAG_BALANCED, Flag.BALANCED),
    (rk.FLAG_GRAZING, Flag.GRAZING),
    (rk.FLAG_NO_SECOND, Flag.NO_SECOND),
    (rk.FLAG_NO_THIRD, Flag.NO_THIRD),
)
_FLAGS = tuple(tuple(flag for bit, flag in FLAG_BITS if bits & bit) for bits in range(1 << len(FLAG_BITS)))
"""The flags of a state by the sum of their bits."""


def decoded_answers(pair: Pair, options: SolveOptions, poses_deg: Array, records: Array) -> list[Answer]:
    """The states of poses of shape (n, 3), in degrees, from their records; an undecided one has its reason instead."""
    decided = records[:, rk.O_STATUS] == 0.0
    states = iter(decoded_states(pair, options, poses_deg[decided], records[decided]))
    return [
        next(states) if known else UndecidedPose(roll, pitch, phase, SEARCH_ENDED)
        for (roll, pitch, phase), known in zip(poses_deg.tolist(), decided.tolist(), strict=True)
    ]


def decoded_states(pair: Pair, options: SolveOptions, poses_deg: Array, records: Array) -> list[ContactState]:
    """The states of poses of shape (n, 3), in degrees, from their records of shape (n, RECORD_SIZE).

    Raises:
        UnresolvedPoseError: a record is unresolved: the search could not exclude all its boxes.
    """
    unresolved = np.flatnonzero(records[:, rk.O_STATUS] != 0.0)
    if len(unresolved):
        raise UnresolvedPoseError(*poses_deg[unresolved[0]].tolist())
    pivot_threshold = options.quasi_stable_fraction * pair.nominal_diameter / 2.0
    embedment_tolerance = options.embedment_tolerance * pair.thread_pitch
    states = []
    for pose, bits, poses, lambda_deg, mu_deg, drop, embedment, pivot_offset, contacts in zip(
        poses_deg.tolist(),
        _integers(records[:, rk.O_FLAGS]),
        _stage_poses(records),
        _present(map(math.degrees, records[:, rk.O_LAMBDA].tolist())),
        _present(map(math.degrees, records[:, rk.O_MU].tolist())),
        _present(records[:, rk.O_DROP].tolist()),
        _present(records[:, rk.O_EMBEDMENT].tolist()),
        _present(records[:, rk.O_PIVOT].tolist()),
        _contacts(records),
        strict=True,
    ):
        classification = classify(
            flush=bits & rk.FLAG_FLUSH != 0,
            third=mu_deg is not None,
            drop=drop,
            embedment=embedment,
            pivot_offset=pivot_offset,
            pivot_threshold=pivot_threshold,
            embedment_tolerance=embedment_tolerance,
        )
        states.append(
            ContactState(
                roll_deg=pose[0],
                pitch_deg=pose[1],
                phase_deg=pose[2],
                state_class=classification.state_class,
                flags=_FLAGS[bits],
                poses=poses,
                lambda_deg=lambda_deg,
                mu_deg=mu_deg,
                drop=drop,
                embedment=embedment,
                pivot_offset=pivot_offset,
                drop_margin=classification.drop_margin,
                embedment_margin=classification.embedment_margin,
                pivot_margin=classification.pivot_margin,
                contacts=contacts,
            )
        )
    return states


def _stage_poses(records: Array) -> list[tuple[StagePose, ...]]:
    """The poses of every record's stages."""
    counts = records[:, rk.O_POSES]
    found = _used(records[:, rk.O_POSE : rk.O_CONTACT].reshape(-1, STAGES, 12), counts)
    rotations = zip(_vectors(found, 0), _vectors(found, 3), _vectors(found, 6), strict=True)
    poses = map(StagePose, rotations, _vectors(found, 9))
    return [tuple(islice(poses, count)) for count in _integers(counts)]


def _contacts(records: Array) -> list[tuple[Contact, ...]]:
    """The contacts of every record."""
    counts = records[:, rk.O_CONTACTS]
    found = _used(records[:, rk.O_CONTACT :].reshape(-1, rk.MAX_RECORD_CONTACTS, rk.POINT_SIZE), counts)
    # In the order of the fields: named, they take a third longer.
    contacts = map(
        Contact,
        _integers(found[:, rk.P_STAGE]),
        _vectors(found, rk.P_POINT),
        _vectors(found, rk.P_BOLT_POINT),
        _vectors(found, rk.P_NORMAL),
        map(SIDE_REGIONS.__getitem__, _integers(found[:, rk.P_BOLT_REGION])),
        map(NUT_REGIONS.__getitem__, _integers(found[:, rk.P_NUT_REGION])),
        map(FEATURES.__getitem__, _integers(found[:, rk.P_PAIR])),
        found[:, rk.P_BOLT_MARGIN].tolist(),
        found[:, rk.P_NUT_MARGIN].tolist(),
    )
    return [tuple(islice(contacts, count)) for count in _integers(counts)]


def _used(blocks: Array, counts: Array) -> Array:
    """The first ``counts[i]`` blocks of record i, for all i in order: of shape (n, m, k) into (sum of counts, k)."""
    return blocks[np.arange(blocks.shape[1]) < counts[:, np.newaxis]]


def _vectors(blocks: Array, at: int) -> Iterable[Vector]:
    """The three numbers from column ``at`` on of every block."""
    return zip(blocks[:, at].tolist(), blocks[:, at + 1].tolist(), blocks[:, at + 2].tolist(), strict=True)


def _integers(column: Array) -> list[int]:
    return column.astype(np.intp).tolist()


def _present(column: Iterable[float]) -> list[float | None]:
    """None for NaN."""
    return [None if math.isnan(value) else value for value in column]
