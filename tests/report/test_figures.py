"""Curves and maps: what they are drawn from, and that a reader can tell their parts apart."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import pytest

from tests.report.example import GRID, INPUTS, example_report, orientations, path
from tests.report.test_contents import report_of
from threadstate.device.assembly_document import AssemblyDocument, assembly_document
from threadstate.device.assembly_model import PathEventKind
from threadstate.report.chart_svg import chart_svg, phase_labels, ticks
from threadstate.report.curves import charts_of, course_of, marks_of, points_of_events
from threadstate.report.map_section import critical_map, share_map
from threadstate.report.map_svg import map_svg, shade_of
from threadstate.report.style import DARK, LIGHT
from threadstate.report.words import MINUS
from threadstate.units import LengthUnit

SVG = "{http://www.w3.org/2000/svg}"
HALF_LABEL_PX = 14.0
"""Half the width of a label of three digits."""
READABLE = 4.5
"""The contrast that the guidelines for accessible pages ask of text (WCAG 2.2, 1.4.3)."""


def parsed(svg: str) -> ElementTree.Element:
    """A picture as a tree, in the name space that it has within a page."""
    return ElementTree.fromstring(svg.replace("<svg ", f'<svg xmlns="{SVG[1:-1]}" ', 1))


@pytest.fixture(scope="module")
def turned() -> AssemblyDocument:
    """A path that snaps and engages."""
    return assembly_document(path(0.0, -2.0, 180.0), LengthUnit.INCH)


@pytest.mark.slow
def test_the_curves_end_with_the_energies_of_the_path(turned: AssemblyDocument) -> None:
    energy = turned["energy"]
    assert energy is not None
    curves = {series.name: series.values for chart in charts_of(turned) for series in chart.series}
    tolerance = 1e-12
    for name, key in (
        ("elastic", "elastic"),
        ("work of the hand", "work"),
        ("work of the push", "push"),
        ("lost in falls", "falls"),
        ("error of the sum", "balance"),
    ):
        assert curves[name][-1] == pytest.approx(energy[key], abs=tolerance)  # type: ignore[literal-required]
    travel = turned["travel"]
    assert travel is not None
    assert max(map(abs, curves["torque"])) == pytest.approx(travel["torque"], rel=1e-12)
    assert max(curves["shift"]) == pytest.approx(travel["shift"], rel=1e-12)
    assert max(curves["of the device"]) == pytest.approx(travel["tilt"], rel=1e-12)


@pytest.mark.slow
def test_what_friction_takes_is_what_the_other_energies_leave() -> None:
    document = assembly_document(path(3.0, -2.0, 0.0, 0.1), LengthUnit.MILLIMETRE, 25.4)
    energy = document["energy"]
    assert energy is not None
    assert energy["friction"] > 0.0
    (chart,) = [chart for chart in charts_of(document) if chart.name == "energy"]
    assert chart.series[-1].name == "lost by friction"
    assert chart.series[-1].values[-1] == pytest.approx(energy["friction"] + energy["balance"], abs=1e-10)


@pytest.mark.slow
def test_the_course_turns_back_once_at_the_snap(turned: AssemblyDocument) -> None:
    course = course_of(turned["path"])
    assert set(course.legs) == {0, 1}
    back = course.legs.index(1)
    assert course.phases_deg[back - 1] == max(course.phases_deg)
    assert course.turned_deg[-1] == pytest.approx(
        2.0 * max(course.phases_deg) - course.phases_deg[0] - course.phases_deg[-1]
    )
    marks = marks_of(turned, course)
    assert [mark.turned_deg for mark in marks if mark.kind is PathEventKind.SNAP] == [course.turned_deg[back - 1]]
    phases = turned["path"]["phase"]
    events = turned["events"]
    places = points_of_events(turned["path"], events)
    assert places == sorted(places)
    assert [phases[at] for at in places] == [event["phase"] for event in events]


@pytest.mark.slow
def test_labels_of_the_phase_are_where_the_hand_is(turned: AssemblyDocument) -> None:
    course = course_of(turned["path"])
    labels = list(phase_labels(course))
    assert [turn for turn, _ in labels] == sorted(turn for turn, _ in labels)
    peak = max(course.phases_deg)
    start, turning = course.phases_deg[0], peak - course.phases_deg[0]
    for turn, phase_deg in labels:
        expected = start + turn if turn <= turning else peak - (turn - turning)
        assert phase_deg == pytest.approx(expected, abs=1e-9)
    assert [phase for turn, phase in labels if turn <= turning] == [
        90.0 * i for i in range(math.ceil(start / 90.0), math.floor(peak / 90.0) + 1)
    ]


@pytest.mark.slow
def test_a_chart_has_a_line_for_each_series_within_its_frame(turned: AssemblyDocument) -> None:
    course = course_of(turned["path"])
    marks = marks_of(turned, course)
    for chart in charts_of(turned):
        svg = chart_svg(chart, course, marks)
        tree = parsed(svg)
        lines = [one for one in tree.iter(f"{SVG}path") if (one.get("class") or "").startswith("line line-")]
        legend = len(chart.series) if len(chart.series) > 1 else 0
        assert len(lines) == len(chart.series) + legend
        _, _, width, height = map(float, (tree.get("viewBox") or "").split())
        for x, y in re.findall(r"[ML](-?[\d.]+) (-?[\d.]+)", " ".join(one.get("d") or "" for one in lines)):
            assert 0.0 <= float(x) <= width
            assert 0.0 <= float(y) <= height
        labels = [one for one in tree.iter(f"{SVG}text") if re.fullmatch(rf"{MINUS}?\d+", one.text or "")]
        middle = [float(one.get("x") or 0.0) for one in labels if one.get("class") == "soft middle"]
        assert max(middle) <= width - HALF_LABEL_PX
        assert svg == chart_svg(chart, course, marks)


def test_a_map_has_a_square_for_each_orientation_and_hatches_what_is_undecided() -> None:
    report = report_of(orientations())
    for part in report.parts:
        shown = share_map(report, part)
        assert [(one.roll_deg, one.pitch_deg) for one in shown.squares] == [
            (one.roll_deg, one.pitch_deg) for one in orientations()
        ]
        assert [one.shade == 4 for one in shown.squares] == [one.all_engage for one in part.orientations]
        assert [one.shade == 0 for one in shown.squares] == [one.engaged == 0 for one in part.orientations]
        assert [one.undecided for one in shown.squares] == [one.undecided > 0 for one in part.orientations]
        tree = parsed(map_svg(shown))
        hatched = [one for one in tree.iter(f"{SVG}rect") if (one.get("fill") or "").startswith("url(#hatch-")]
        assert len(hatched) == sum(one.undecided for one in shown.squares) + (part.undecided_paths > 0)
        assert len(list(tree.iter(f"{SVG}g"))) == GRID.orientation_count


def test_the_map_of_the_critical_friction_has_its_interval() -> None:
    report = report_of(orientations())
    by_pose = {(one.roll_deg, one.pitch_deg): one for one in critical_map(report).squares}
    assert by_pose[0.0, 1.0].text == "\N{EN DASH}"
    assert by_pose[1.0, -1.0].text == "0.12"
    assert by_pose[0.0, -1.0].text == "\N{GREATER-THAN OR EQUAL TO}0.2"
    assert by_pose[2.0, -2.0].undecided
    assert by_pose[2.0, -2.0].text.endswith("?")
    assert by_pose[1.0, -1.0].meaning.endswith("0.125 to 0.1313 (idle)")
    assert INPUTS.mu_tolerance >= 0.1313 - 0.125


def test_the_picture_of_a_large_grid_has_no_text_that_does_not_fit() -> None:
    report = report_of(orientations())
    small = share_map(report, report.parts[0])
    tilts = tuple(float(i) for i in range(-20, 21))
    square = small.squares[0]
    svg = map_svg(type(small)("large", "t", "a", tilts, (square,), small.shades))
    texts = [one.text for one in parsed(svg).iter(f"{SVG}text")]
    assert square.text not in texts
    assert 5 <= sum(bool(re.fullmatch(r"\N{MINUS SIGN}?\d+", text or "")) for text in texts) <= 2 * 11


@pytest.mark.parametrize(("share", "shade"), [(0.0, 0), (0.01, 1), (0.25, 1), (0.26, 2), (0.75, 3), (1.0, 4)])
def test_shades_go_by_quarters(share: float, shade: int) -> None:
    assert shade_of(share) == shade


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-3.2e-5, 4.1e-5), (199.0, 201.0), (-0.07, 123.0)])
def test_ticks_are_round_and_within(low: float, high: float) -> None:
    found = ticks(low, high)
    assert 3 <= len(found) <= 7
    assert all(low <= value <= high for value in found)


def luminance(colour: str) -> float:
    """The relative luminance of a colour (WCAG 2.2)."""
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    """The contrast of two colours, 1 to 21."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_text_can_be_read_on_its_ground(palette: str) -> None:
    colours = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", palette))
    for text, ground in (
        *((f"ink-{i}", f"shade-{i}") for i in range(5)),
        *((text, ground) for text in ("ink", "faint", "accent", "fall") for ground in ("paper", "ground")),
        ("fall", "back"),
    ):
        assert contrast(colours[text], colours[ground]) >= READABLE, (text, ground)
    for i in range(5):
        assert contrast(colours[f"line-{i}"], colours["paper"]) >= 3.0
        assert contrast(colours[f"line-{i}"], colours["back"]) >= 3.0


@pytest.mark.slow
def test_the_pictures_of_a_report_say_in_words_what_they_show() -> None:
    report = example_report()
    part = report.parts[1]
    assert f"{part.area.engaged} of 25 orientations" in share_map(report, part).alternative
    chosen = [square for square in share_map(report, part).squares if square.chosen]
    assert [(one.roll_deg, one.pitch_deg) for one in chosen] == [(report.chosen.roll_deg, report.chosen.pitch_deg)]
