"""The study of devices compared: what is computed, and tables, pictures and words of maps that are made up."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from studies.devices_compared.page import SHIFT, TORQUE, bars, page, pictures, seen, table
from studies.devices_compared.study import (
    DEFAULT,
    FRICTION_GRID,
    GRID,
    MORE_FORCE,
    MU,
    Row,
    Variant,
    all_inputs,
    comparisons,
    friction_comparison,
    like_outcomes,
    row,
    scaled_device,
    tilt_deg,
)
from studies.success.study import StudiedMap
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.document import device_document
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Orientation
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, CriticalFriction, OrientationMap
from threadstate.success.scaled import scaled_orientation
from threadstate.units import LengthUnit

ENGAGED, IDLE, UNDECIDED = AssemblyOutcome.ENGAGED, AssemblyOutcome.IDLE, AssemblyOutcome.UNDECIDED
INCH_MM = 25.4


def engaged(i: int, mu: float) -> Cell:
    """A path that engages; every fifth one asks for more shift than the travel has."""
    return Cell(0.0, mu, ENGAGED, (), False, (0.25 + mu) / INCH_MM, 1.5, (3.0 if i % 5 == 0 else 1.25) / INCH_MM, 90.0)


def made_up(inputs: SuccessInputs, cell: Callable[[int, float], Cell]) -> StudiedMap:
    """The map whose paths the function gives by orientation and friction, lengths in inches."""
    critical = CriticalFriction(None, None, None, None, reenters=False)
    orientations = []
    for i in range(inputs.grid.orientation_count):
        place = inputs.grid.orientation(i)
        cells = tuple(cell(i, mu) for mu in inputs.frictions)
        orientations.append(OrientationMap(i, place.roll_deg, place.pitch_deg, cells, (), critical))
    return StudiedMap(inputs, orientations)


def mixed(i: int, mu: float) -> Cell:
    """Ten engage, two of which with too much shift; two are undecided; one idle path has a larger shift."""
    if i < 10:
        return engaged(i, mu)
    if i < 12:
        return Cell(0.0, mu, UNDECIDED, (), True, None, None, None, None)
    return Cell(0.0, mu, IDLE, (), False, 9.0, 9.0, 9.0, 90.0)


@pytest.fixture(scope="module")
def maps() -> dict[str, StudiedMap]:
    """Maps of all that the study computes; by ``cw`` those with an even number engage."""
    maps = {}
    for inputs in all_inputs():
        by_cw = inputs.strategy is Strategy.CW

        def cell(i: int, mu: float, *, by_cw: bool = by_cw, push: float = inputs.device.push) -> Cell:
            one = mixed(i, mu)
            if by_cw and i % 2 and one.engages:
                one = replace(one, outcome=IDLE)
            return one if one.torque is None else replace(one, torque=one.torque * push / 10.0)

        one = made_up(inputs, cell)
        if inputs.pair.unit is LengthUnit.MILLIMETRE:
            one = replace(one, orientations=[scaled_orientation(found, INCH_MM) for found in one.orientations])
        maps[inputs.sha256] = one
    return maps


def test_each_variant_differs_from_the_default_in_what_its_section_says() -> None:
    default = device_document(default_device())
    expected = {"centre": "centre", "tilt-stiffness": "k_tilt", "lateral-stiffness": "k_lateral", "about": "about"} | {
        "ccw-turn": "ccw_turn"
    }
    for comparison in comparisons():
        key = expected.get(comparison.name)
        changed = [
            {name for name, value in device_document(variant.device).items() if value != default[name]}
            for variant in comparison.variants
        ]
        if key is not None:
            assert all(names <= {key} for names in changed), comparison.name
            assert sum(not names for names in changed) == 1, comparison.name
            assert [variant.label.endswith("(default)") for variant in comparison.variants] == [
                not names for names in changed
            ]
        if comparison.name == "classes":
            assert not any(changed)


def test_a_scaled_device_scales_with_the_diameter_and_forces_with_forces() -> None:
    scaled, default = device_document(scaled_device(2.0, 3.0)), device_document(default_device())
    assert scaled["k_lateral"] == 3.0 / 2.0 * default["k_lateral"]
    assert scaled["k_tilt"] == 3.0 * 2.0 * default["k_tilt"]
    assert scaled["push"] == 3.0 * default["push"]
    names = [variant.name for variant in comparisons()[-1].variants]
    metric = next(variant for variant in comparisons()[-1].variants if variant.name == "M10x1.5 scaled")
    assert device_document(metric.device)["k_tilt"] == pytest.approx(500.0 * 10.0 / 6.35, rel=1e-12)
    assert "1/4-20 UNC scaled" not in names


def test_every_map_is_computed_once_and_pairs_refused_or_without_play_are_not() -> None:
    found = all_inputs()
    assert len({inputs.sha256 for inputs in found}) == len(found)
    assert {inputs.grid for inputs in found if inputs.frictions == (0.0,)} == {GRID}
    assert {inputs.grid for inputs in found if inputs.frictions == (0.0, MU)} == {FRICTION_GRID}
    omitted = {
        variant.name: variant for comparison in comparisons() for variant in comparison.variants if variant.omission
    }
    assert "bolt_root_fillet" in str(omitted["2A/2B with sharp corners"].omission)
    assert "no play" in str(omitted["3A/3B at maximum material"].omission)
    assert len(omitted) == 2
    assert all(variant.pair not in [inputs.pair for inputs in found] for variant in omitted.values())


def test_a_row_counts_in_millimetres_and_those_that_engage_alone() -> None:
    one = row("x", made_up(DEFAULT.inputs(Strategy.CW), mixed))
    assert (one.paths, one.engaged, one.within, one.undecided) == (81, 10, 8, 2)
    assert one.torque == pytest.approx(0.25)
    assert one.shift == pytest.approx(3.0)
    assert one.tilt_deg == 1.5
    metric = Variant("M6", default_device(), "M6x1")
    assert row("x", made_up(metric.inputs(Strategy.CW), engaged)).shift == 3.0 / INCH_MM


def test_the_tilt_of_a_command_is_that_of_its_axis() -> None:
    assert tilt_deg(Orientation(0, 3.0, 0.0)) == pytest.approx(3.0, abs=1e-9)
    assert tilt_deg(Orientation(0, -3.0, 4.0)) == pytest.approx(5.0, abs=2e-3)


def test_a_row_has_the_friction_that_is_asked_for() -> None:
    one = made_up(DEFAULT.inputs(Strategy.CW, with_friction=True), engaged)
    assert [row("x", one, mu).torque for mu in (0.0, MU)] == [pytest.approx(0.25), pytest.approx(0.45)]


def test_a_map_without_an_engaging_path_has_no_needs() -> None:
    one = row("x", made_up(DEFAULT.inputs(Strategy.CW), lambda i, mu: replace(mixed(11, mu), phase_deg=0.0 * i)))
    assert (one.engaged, one.undecided, one.torque, one.shift) == (0, 81, None, None)
    assert "| x | `cw` | 0 of 81 | 0 | 81 | - | - | - |" in table("device", [one])
    assert "none engages" in bars("title", "varied", [replace(one, strategy=strategy) for strategy in Strategy], SHIFT)


def rows_of(*values: tuple[str, Strategy, int, float]) -> list[Row]:
    """Rows of which name, strategy, number that engage and shift are given."""
    return [
        Row(name, strategy, 81, count, count - 1, 0, 1.0, 2.0, shift, "0123456789abcdef")
        for name, strategy, count, shift in values
    ]


def test_words_have_the_ends_and_all_that_reach_them() -> None:
    first, second = Strategy
    words = seen(
        rows_of(
            ("a (default)", first, 40, 1.0),
            ("b", first, 30, 1.25),
            ("c", first, 40, 2.5),
            *((name, second, 7, 0.5) for name in "abc"),
        )
    ).splitlines()
    assert words == [
        "- By `ccw_then_cw`, of 81 orientations, 30 (b) to 40 (a, c) engage; within the travel 29 (b) to 39 (a, c). "
        "The largest shift is 1 mm (a) to 2.5 mm (c).",
        "- By `cw`, of 81 orientations, 7 engage; within the travel 6. The largest shift is 0.5 mm.",
    ]


def test_the_page_has_every_variant_by_its_strategies(maps: dict[str, StudiedMap]) -> None:
    text = page(maps)
    counts = {Strategy.CCW_THEN_CW: "10 of 81 | 8 | 2", Strategy.CW: "5 of 81 | 4 | 2"}
    for comparison in comparisons():
        start = text.index(f"## {comparison.title}\n")
        section = text[start : text.find("\n## ", start)]
        for variant in comparison.computed:
            for strategy in comparison.strategies:
                digits = maps[variant.inputs(strategy).sha256].content_sha256[:12]
                needs = f"0.25 | 1.5 | 3 | `{digits}`"
                assert f"| {variant.label} | `{strategy.value}` | {counts[strategy]} | {needs} |" in section
        for variant in comparison.variants:
            if variant.omission is not None:
                assert f"| {variant.name} | not computed |" in section
                assert f"{variant.name} is not computed: {variant.omission}." in " ".join(section.split())
    assert "By `ccw_then_cw` of 81 paths end 10 engaged, 69 idle, 2 undecided." in text
    assert "in 49 of the 81 orientations" in text
    assert "5 orientations engage by both, 5 by the first alone, 0 by the second alone." in text
    for variant in friction_comparison().computed:
        assert f"| {variant.name}, mu 0 | `ccw_then_cw` | 10 of 25 | 8 | 2 | 0.25 |" in text
        assert f"| {variant.name}, mu 0.2 | `ccw_then_cw` | 10 of 25 | 8 | 2 | 0.45 |" in text


def test_more_force_is_compared_path_by_path(maps: dict[str, StudiedMap]) -> None:
    assert "81 of 81 paths by `ccw_then_cw` end as they do" in " ".join(page(maps).split())
    inputs = MORE_FORCE.inputs(Strategy.CCW_THEN_CW)
    other = {**maps, inputs.sha256: made_up(inputs, lambda i, mu: mixed(i + 1, mu))}
    assert "79 of 81 paths by `ccw_then_cw` end as they do" in " ".join(page(other).split())
    assert len(like_outcomes(maps[DEFAULT.inputs(Strategy.CW).sha256], made_up(inputs, mixed))) == 76


def test_pictures_are_those_that_the_page_shows_and_have_the_numbers(maps: dict[str, StudiedMap]) -> None:
    drawn = pictures(maps)
    shown = re.findall(r"\]\(devices-compared/([a-z-]+)\.svg\)", page(maps))
    assert shown == list(drawn)
    centre = drawn["centre"]
    assert centre.count(">10 (8)<") == 7
    assert drawn["strategies"].count(">10 (8)<") == drawn["strategies"].count(">5 (4)<") == 1
    assert ">0 (default)<" in centre
    assert drawn["friction"].count(">10 (8)<") == 2 * len(friction_comparison().computed)
    assert "largest torque (N mm)" in drawn["friction"]


def test_a_picture_is_drawn_alike_twice_and_has_the_limit_where_it_is_near() -> None:
    found = rows_of(*(("a", strategy, 40, 2.0) for strategy in Strategy))
    assert bars("title", "varied", found, SHIFT) == bars("title", "varied", found, SHIFT)
    dashed = "stroke-dasharray"
    far = [replace(one, shift=10.0) for one in found]
    assert dashed in bars("title", "varied", far, SHIFT)
    assert dashed not in bars("title", "varied", found, SHIFT)
    assert dashed not in bars("title", "varied", far, TORQUE)
