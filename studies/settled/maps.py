"""Maps over the grid: what the bolt rests on, and how far from the paper's last pose its axis is then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from studies.settled.study import SETTLED_KINDS, ComparedPose
from studies.stability.maps import Map, Shade

LIMITS_DEG = (0.1, 1.0, 2.0, 4.0)


@dataclass(frozen=True)
class MapRow:
    """An orientation with its poses by phase."""

    roll_deg: float
    pitch_deg: float
    poses: Sequence[ComparedPose]


def map_rows(poses: Sequence[ComparedPose]) -> list[MapRow]:
    """The rows of the maps; the poses are in the order of the grid."""
    groups = groupby(poses, key=lambda one: (one.state.roll_deg, one.state.pitch_deg))
    return [MapRow(roll, pitch, list(group)) for (roll, pitch), group in groups]


def _rest_shade(one: ComparedPose) -> int:
    return SETTLED_KINDS.index(one.settled_kind)


def _apart_shade(one: ComparedPose) -> int:
    apart = one.apart_deg
    return len(LIMITS_DEG) + 1 if apart is None else sum(apart >= limit for limit in LIMITS_DEG)


MAPS: tuple[Map[ComparedPose], ...] = (
    Map(
        "rest",
        "What a bolt rests on that the default device holds and pushes",
        "Contacts that carry a force. Where the bolt is not settled there is no certain answer.",
        (
            Shade("#d55e00", "flush"),
            Shade("#0072b2", "three contacts or more"),
            Shade("#f0c808", "two"),
            Shade("#f4f1ea", "one"),
            Shade("#000000", "not settled"),
        ),
        _rest_shade,
    ),
    Map(
        "apart",
        "Angle between the bolt's axis at rest and in the paper's last pose",
        "Dark where the paper's turns lead far from where the bolt rests.",
        (
            Shade("#f4f1ea", "less than 0.1 deg"),
            Shade("#bcd9e6", "0.1 to 1 deg"),
            Shade("#7db4d0", "1 to 2 deg"),
            Shade("#3d84b0", "2 to 4 deg"),
            Shade("#04233f", "4 deg and more"),
            Shade("#d55e00", "not settled"),
        ),
        _apart_shade,
    ),
)
