"""Maps over the grid: a row for each of the 81 orientations, a column for each of the 360 phases."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby, zip_longest
from typing import Generic, Protocol, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.transforms import Transform
from numpy.typing import NDArray

from studies.pictures import FAINT, picture
from studies.stability.agreement import Outcome
from studies.stability.grid_study import DECADES, GridPose, logarithm
from studies.stability.tangent_study import WRONG_DEG
from threadstate.state.model import StateClass

PHASE_TICK_DEG = 30

Seen = TypeVar("Seen")
PoseThere = TypeVar("PoseThere", covariant=True)


class Row(Protocol[PoseThere]):
    """An orientation of the grid with what was seen at each phase."""

    @property
    def roll_deg(self) -> float:
        """Of all poses."""

    @property
    def pitch_deg(self) -> float:
        """Of all poses."""

    @property
    def poses(self) -> Sequence[PoseThere]:
        """By phase, from 0 on."""


@dataclass(frozen=True)
class Shade:
    """A colour and what it stands for."""

    colour: str
    meaning: str


@dataclass(frozen=True)
class Map(Generic[Seen]):
    """A map: its file's name, its title, what it shows in a sentence, its shades, and which of them a pose has."""

    name: str
    title: str
    caption: str
    shades: tuple[Shade, ...]
    shade_of: Callable[[Seen], int]


_CLASSES = (StateClass.STABLE_THREE_POINT, StateClass.QUASI_STABLE_TWO_POINT, StateClass.UNSTABLE_TWO_POINT)
_SLOPES = (0.0, 1.0, 2.0, 3.0, 4.0)
_ERRORS_DEG = (WRONG_DEG, 1.0, 30.0, 90.0, 180.1)


def _class_shade(pose: GridPose) -> int:
    return len(_CLASSES) if pose.state_class is None else _CLASSES.index(pose.state_class)


def _event_shade(pose: GridPose) -> int:
    if pose.state_class is None:
        return len(DECADES) + 1
    return len(DECADES) if pose.event_decade is None else DECADES.index(pose.event_decade)


def _slope_shade(pose: GridPose) -> int:
    value = logarithm(pose.slope)
    if value is None:
        return len(_SLOPES) + 1
    return sum(value >= limit for limit in _SLOPES)


def _tangent_shade(pose: GridPose) -> int:
    error = pose.directions.nut_tangent
    if error is None:
        return len(_ERRORS_DEG) + 1
    if math.isnan(error):
        return len(_ERRORS_DEG)
    return sum(error >= limit for limit in _ERRORS_DEG[:-1])


# Colours of Okabe and Ito for kinds; a ramp of one hue from light to dark for sizes.
MAPS: tuple[Map[GridPose], ...] = (
    Map(
        "classes",
        "Class of the state",
        "Every border between two colours is a place where a class may flip.",
        (
            Shade("#0072b2", "stable three-point"),
            Shade("#f0c808", "quasi-stable two-point"),
            Shade("#d55e00", "unstable two-point"),
            Shade("#000000", "refused"),
        ),
        _class_shade,
    ),
    Map(
        "events",
        "The smallest change of pose after which other contacts take over",
        "Dark poses are at an event: a tie, a lost or a new contact. Changes in one direction at four sizes.",
        (
            Shade("#3b0f70", "1e-12 deg"),
            Shade("#8c2981", "1e-9 deg"),
            Shade("#de4968", "1e-6 deg"),
            Shade("#fe9f6d", "1e-3 deg"),
            Shade("#f4f1ea", "none of these"),
            Shade("#000000", "refused"),
        ),
        _event_shade,
    ),
    Map(
        "slopes",
        "Change of a turn or of a contact point per change of the pose",
        "Largest of both turns (times the bolt's reach) and of all contact points, over the farthest way of a point of "
        "the bolt; by changes of 1e-6 deg.",
        (
            Shade("#edf4f7", "below 1"),
            Shade("#bcd9e6", "1 to 10"),
            Shade("#7db4d0", "10 to 100"),
            Shade("#3d84b0", "100 to 1,000"),
            Shade("#175582", "1,000 to 10,000"),
            Shade("#04233f", "above 10,000"),
            Shade("#e69f00", "no slope: level, other contacts, or refused"),
        ),
        _slope_shade,
    ),
    Map(
        "tangents",
        "Error of the tangent's direction by the printed Eq. 7",
        "The acos of Eq. 7 loses the sign of the tangent's y part; atan2 is right in every pose.",
        (
            Shade("#e8f1ee", "right to 1e-6 deg"),
            Shade("#b5d8cb", "below 1 deg"),
            Shade("#6db59c", "1 to 30 deg"),
            Shade("#1e8a6c", "30 to 90 deg"),
            Shade("#00493a", "90 to 180 deg"),
            Shade("#d55e00", "no number"),
            Shade("#999999", "level: no tangent"),
        ),
        _tangent_shade,
    ),
)


_OUTCOMES = (Outcome.RIGHT, Outcome.HEIGHT, Outcome.REFUSED)

DECADE_MAP: Map[Outcome] = Map(
    "decades",
    "Where the descent in decades ends",
    "A wrong height is off by more than the meshes' edges deviate and the final step together.",
    (Shade("#e8f1ee", "at the first contact"), Shade("#d55e00", "wrong height"), Shade("#000000", "refused")),
    _OUTCOMES.index,
)


def colours(chart: Map[Seen], rows: Sequence[Row[Seen]]) -> NDArray[np.uint8]:
    """The colour of every pose as red, green and blue, shape (rows, phases, 3); rows in the order of the grid.

    There is a white row between one roll and the next.
    """
    palette = np.array([to_rgb(shade.colour) for shade in chart.shades])
    found: list[NDArray[np.float64]] = []
    for row, after in zip_longest(rows, rows[1:]):
        found.append(palette[[chart.shade_of(pose) for pose in row.poses]])
        if after is not None and after.roll_deg != row.roll_deg:
            found.append(np.ones_like(found[-1]))
    return np.asarray(np.round(255.0 * np.array(found)), dtype=np.uint8)


def drawn(chart: Map[Seen], rows: Sequence[Row[Seen]]) -> str:
    """The map as SVG; rows in the order of the grid."""
    image = colours(chart, rows)
    groups = [list(group) for _, group in groupby(rows, key=lambda row: row.roll_deg)]

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        axes.imshow(image, extent=(0.0, 360.0, len(image), 0.0), aspect="auto", interpolation="none")
        pitches: dict[float, str] = {}
        top = 0
        for group in groups:
            middle = top + len(group) / 2
            axes.text(-0.045, middle, f"roll {group[0].roll_deg:g}", ha="right", va="center", transform=_beside(axes))
            marked = sorted({0, len(group) // 2, len(group) - 1})
            pitches |= {top + k + 0.5: f"{group[k].pitch_deg:g}" for k in marked}
            top += len(group) + 1
        axes.set_yticks(list(pitches), list(pitches.values()), fontsize="x-small")
        axes.tick_params(axis="y", length=0.0)
        axes.text(-0.008, -0.7, "pitch", ha="right", fontsize="x-small", color=FAINT, transform=_beside(axes))
        axes.set_xticks(range(0, 361, PHASE_TICK_DEG))
        axes.set_xlabel("phase (deg); roll and pitch in deg")
        axes.grid(visible=False)
        axes.spines[:].set_visible(False)
        axes.set_title(chart.caption, fontsize="medium", fontweight="normal", color=FAINT)
        figure.suptitle(chart.title, x=0.01, ha="left", fontsize="x-large")
        shades = [Patch(facecolor=one.colour, edgecolor=FAINT, label=one.meaning) for one in chart.shades]
        layout = {"ncols": len(shades), "columnspacing": 1.2, "handlelength": 1.2, "fontsize": "small"}
        figure.legend(handles=shades, loc="outside lower center", **layout)

    return picture((11.0, 6.6), chart.title, draw)


def _beside(axes: Axes) -> Transform:
    """Across as a share of the axes' width, up and down by rows."""
    return axes.get_yaxis_transform()
