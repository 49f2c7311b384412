"""What is compared: devices, strategies and pairs of which each differs from the default in one thing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from studies.success.study import FARTHER_DEG, StudiedMap
from threadstate.device.document import device_document, device_from_document
from threadstate.device.model import About, Device, Limits, default_device
from threadstate.device.settle import check_pair
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid, Orientation
from threadstate.numbers import number_text
from threadstate.success.design import is_within
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.scaled import scaled_orientation
from threadstate.success.summary import grid_cells
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_play
from threadstate.units import LengthUnit, conversion_factor

GRID = Grid(4.0, 1.0, 360.0)
"""All 81 orientations of the default grid, from one phase, without friction."""
FRICTION_GRID = Grid(4.0, 2.0, 360.0)
"""25 of them, with friction: such a path takes ten times as long as one without."""
MU = 0.2
TILT_LIMIT_DEG, SHIFT_LIMIT_MM = 4.0, 2.5
LIMITS = Limits(TILT_LIMIT_DEG, SHIFT_LIMIT_MM)
"""The travel that a device may be asked for: tilt (deg) and shift (mm), as in the example of docs/design.md."""

DEFAULT_PAIR = "1/4-20 UNC"
CENTRES_MM = (-10.0, -5.0, -2.0, 0.0, 2.0, 5.0, 10.0)
TILT_STIFFNESSES = (50.0, 125.0, 250.0, 500.0, 1000.0, 2000.0)
"""N mm/rad."""
LATERAL_STIFFNESSES = (2.0, 5.0, 20.0, 80.0, 320.0)
"""N/mm."""
CCW_TURNS_DEG = (180.0, 345.0, 360.0, 375.0, FARTHER_DEG, 450.0)
CLASSES = ("3A/3B", "2A/2B", "1A/1B")
POSITIONS = ("at maximum material", "at minimum material")
SHARP = "2A/2B with sharp corners"
"""As the standard allows them, and as the device's solver does not take them."""
SIZES = ("M6x1", DEFAULT_PAIR, "M10x1.5")
FORCES = 10.0
"""How many times the default push and stiffnesses are taken, all by the same factor."""
LEAST_PLAY = 1e-6
"""Over the thread pitch: of pairs with less no map is computed."""
NO_PLAY = "it has no play, and a path then takes many times as long as with play"
LARGEST_MU_TOLERANCE = 1.0
"""Of critical frictions, which are not looked for."""


@dataclass(frozen=True)
class Variant:
    """A device and a pair.

    Attributes:
        name: what differs from the default, as a table's row has it.
        designation: of the pair.
        device: that holds the bolt.
    """

    name: str
    device: Device
    designation: str = DEFAULT_PAIR

    @property
    def label(self) -> str:
        """The name, and whether it is the default."""
        is_default = (self.pair, self.device) == (DEFAULT.pair, DEFAULT.device) and self.name != DEFAULT.name
        return f"{self.name} (default)" if is_default else self.name

    @cached_property
    def pair(self) -> Pair:
        """The pair of the designation."""
        return pair_by_designation(self.designation)

    @cached_property
    def omission(self) -> str | None:
        """Why no map of it is computed; None where one is."""
        try:
            check_pair(self.pair)
        except InvalidValueError as error:
            return f"the device's solver refuses it ({error})"
        return NO_PLAY if axial_play(self.pair) <= LEAST_PLAY * self.pair.thread_pitch else None

    def inputs(self, strategy: Strategy, *, with_friction: bool = False) -> SuccessInputs:
        """What the map is computed from: without friction, or at few orientations without it and with it."""
        grid, frictions = (FRICTION_GRID, (0.0, MU)) if with_friction else (GRID, (0.0,))
        return SuccessInputs(
            self.pair,
            self.device,
            strategy,
            grid,
            frictions,
            phase_tolerance_deg=grid.phase_step_deg,
            mu_tolerance=LARGEST_MU_TOLERANCE,
        )


@dataclass(frozen=True)
class Comparison:
    """Variants of which one thing differs.

    Attributes:
        name: of its picture's file.
        title: of its section.
        varied: what differs, with its unit: the head of the table's first column and the picture's axis.
        variants: in the order of the table.
        strategies: by which the hand turns.
    """

    name: str
    title: str
    varied: str
    variants: tuple[Variant, ...]
    strategies: tuple[Strategy, ...] = (Strategy.CCW_THEN_CW,)

    @property
    def computed(self) -> tuple[Variant, ...]:
        """The variants of which maps are computed."""
        return tuple(variant for variant in self.variants if variant.omission is None)


@dataclass(frozen=True)
class Row:
    """What a map says at one friction.

    Attributes:
        name: of what was computed, as tables and pictures have it.
        strategy: by which the hand turns.
        paths: how many there are, one for each orientation.
        engaged: how many of them end engaged.
        within: how many of these ask for no more travel than ``LIMITS``.
        undecided: how many have no certain outcome.
        torque: the largest that those which engage ask for (N mm); as tilt and shift None where none does.
        tilt_deg: the largest tilt of theirs.
        shift: their largest shift (mm).
        content_sha256: of the map.
    """

    name: str
    strategy: Strategy
    paths: int
    engaged: int
    within: int
    undecided: int
    torque: float | None
    tilt_deg: float | None
    shift: float | None
    content_sha256: str


def held(**values: float | str) -> Device:
    """The default device with other values of its document, lengths in millimetres."""
    return device_from_document({"unit": LengthUnit.MILLIMETRE, **values})


def scaled_device(scale: float, forces: float = 1.0) -> Device:
    """The default device with all lengths multiplied by ``scale`` and all forces by ``forces``."""
    device = default_device()
    stiffness = device_document(device)
    return held(
        k_lateral=stiffness["k_lateral"] * forces / scale,
        k_tilt=stiffness["k_tilt"] * forces * scale,
        centre=device.centre * scale,
        push=device.push * forces,
    )


DEFAULT = Variant("default", default_device())
MORE_FORCE = Variant(f"push and stiffnesses times {number_text(FORCES)}", scaled_device(1.0, FORCES))
MORE_FORCE_STRATEGY = Strategy.CCW_THEN_CW


def comparisons() -> tuple[Comparison, ...]:
    """All that are computed without friction, from all orientations."""
    return (
        Comparison("strategies", "Strategies", "device", (DEFAULT,), tuple(Strategy)),
        Comparison(
            "centre",
            "Height of the compliance centre",
            "centre (mm)",
            tuple(Variant(number_text(height), held(centre=height)) for height in CENTRES_MM),
        ),
        Comparison(
            "tilt-stiffness",
            "Stiffness against tilt",
            "k_tilt (N mm/rad)",
            tuple(Variant(number_text(value), held(k_tilt=value)) for value in TILT_STIFFNESSES),
        ),
        Comparison(
            "lateral-stiffness",
            "Stiffness against shift",
            "k_lateral (N/mm)",
            tuple(Variant(number_text(value), held(k_lateral=value)) for value in LATERAL_STIFFNESSES),
        ),
        Comparison(
            "about",
            "What the hand turns about",
            "about",
            tuple(Variant(about.value, held(about=about.value)) for about in About),
        ),
        Comparison(
            "ccw-turn",
            "How far the hand turns until the snap",
            "ccw_turn (deg)",
            tuple(Variant(number_text(turn), held(ccw_turn=turn)) for turn in CCW_TURNS_DEG),
        ),
        Comparison("classes", "Classes of 1/4-20 UNC at both ends of their tolerances", "pair", _classes()),
        Comparison("sizes", "Sizes", "pair and device", _sizes()),
    )


def friction_comparison() -> Comparison:
    """What is computed with friction, too: the default, a loose pair, the stiffest device and a farther turn."""
    loose, high_tilt = f"{DEFAULT_PAIR}-2A/2B at minimum material", TILT_STIFFNESSES[-1]
    variants = (
        DEFAULT,
        Variant("2A/2B at minimum material", default_device(), loose),
        Variant(f"k_tilt {number_text(high_tilt)} N mm/rad", held(k_tilt=high_tilt)),
        Variant(f"ccw_turn {number_text(FARTHER_DEG)} deg", held(ccw_turn=FARTHER_DEG)),
    )
    return Comparison("friction", "With friction", "device and friction", variants)


def all_inputs() -> list[SuccessInputs]:
    """What all maps are computed from, each once; those with friction last."""
    with_friction = friction_comparison()
    inputs = [
        variant.inputs(strategy)
        for comparison in comparisons()
        for strategy in comparison.strategies
        for variant in comparison.computed
    ]
    inputs.append(MORE_FORCE.inputs(MORE_FORCE_STRATEGY))
    inputs += [
        variant.inputs(strategy, with_friction=True)
        for variant in with_friction.computed
        for strategy in with_friction.strategies
    ]
    return list({one.sha256: one for one in inputs}.values())


def tilt_deg(orientation: Orientation) -> float:
    """By how much a commanded axis is tilted against the nut's."""
    roll, pitch = math.radians(orientation.roll_deg), math.radians(orientation.pitch_deg)
    return math.degrees(math.acos(math.cos(roll) * math.cos(pitch)))


def in_millimetres(one: StudiedMap) -> list[OrientationMap]:
    """The orientations of a map with lengths in millimetres, torques in N mm."""
    factor = conversion_factor(one.inputs.pair.unit, LengthUnit.MILLIMETRE)
    return [scaled_orientation(found, factor) for found in one.orientations]


def row(name: str, one: StudiedMap, mu: float = 0.0) -> Row:
    """What a map says at one of its frictions."""
    cells = [cell for found in in_millimetres(one) for cell in grid_cells(found, one.inputs.grid, mu)]
    engaged = [cell for cell in cells if cell.engages]
    return Row(
        name,
        one.inputs.strategy,
        len(cells),
        len(engaged),
        sum(is_within(cell, LIMITS) for cell in engaged),
        sum(not cell.is_decided for cell in cells),
        _largest([cell.torque for cell in engaged]),
        _largest([cell.tilt_deg for cell in engaged]),
        _largest([cell.shift for cell in engaged]),
        one.content_sha256,
    )


def like_outcomes(one: StudiedMap, other: StudiedMap) -> list[tuple[Cell, Cell]]:
    """The frictionless paths of two maps that end alike, side by side."""
    pairs = [
        (cell, beside)
        for found, again in zip(one.orientations, other.orientations, strict=True)
        for cell, beside in zip(
            grid_cells(found, one.inputs.grid, 0.0), grid_cells(again, other.inputs.grid, 0.0), strict=True
        )
    ]
    return [(cell, beside) for cell, beside in pairs if cell.outcome is beside.outcome]


def _classes() -> tuple[Variant, ...]:
    names = [*(f"{name} {position}" for name in CLASSES for position in POSITIONS), SHARP]
    return tuple(Variant(name, default_device(), f"{DEFAULT_PAIR}-{name}") for name in names)


def _sizes() -> tuple[Variant, ...]:
    """The default device unchanged, and scaled by the nominal diameter over that of the default pair."""
    variants = []
    for name in SIZES:
        scale = _diameter_mm(name) / _diameter_mm(DEFAULT_PAIR)
        variants.append(Variant(f"{name} unchanged", default_device(), name))
        if scale != 1.0:
            variants.append(Variant(f"{name} scaled", scaled_device(scale), name))
    return tuple(variants)


def _diameter_mm(designation: str) -> float:
    pair = pair_by_designation(designation)
    return pair.nominal_diameter * conversion_factor(pair.unit, LengthUnit.MILLIMETRE)


def _largest(values: Sequence[float | None]) -> float | None:
    return max((value for value in values if value is not None), default=None)
