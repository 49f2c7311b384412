"""The page of a report: its numbers are those of the map and the path, it is safe, whole and the same each time."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from tests.report.example import DATE, FRICTIONS, INPUTS, Page, example_report, number_of, orientations, path
from tests.report.test_contents import report_of
from threadstate.device.assembly_document import assembly_document
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.report.contents import ChosenPath
from threadstate.report.page import report_page
from threadstate.report.words import exact, rounded
from threadstate.success.document import map_sha256
from threadstate.success.model import CriticalFriction
from threadstate.success.summary import orientation_summary
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow

SECTIONS = ("answer", "device", "map", "worst", "path", "sure", "repeat", "orientations")
HOSTILE = '</title><script>alert("1")</script><img src="https://example.org/x.png" onerror=\'x\'>&amp; \\'
ASKED = ChosenPath(0.0, -2.0, 180.0, 0.0, "This path was asked for.", is_default=False)


@pytest.fixture(scope="module")
def text() -> str:
    """The page of the example."""
    return report_page(example_report())


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    """What it holds."""
    return Page(text)


def test_the_sections_are_in_the_order_of_a_reader(page: Page) -> None:
    assert tuple(one["id"] for one in page.named("section")) == SECTIONS
    identifiers = [one["id"] for _, one in page.elements if "id" in one]
    assert len(identifiers) == len(set(identifiers))
    assert {one["aria-labelledby"] for one in page.named("section")} <= set(identifiers)
    assert [one["href"] for one in page.named("a")] == [f"#{name}" for name in SECTIONS]
    assert len(page.named("h1")) == 1


def test_every_row_is_that_of_its_orientation(page: Page) -> None:
    table = page.table("Every orientation of the map")
    assert len(table.rows) == len(orientations())
    for row, one in zip(table.rows, orientations(), strict=True):
        summaries = [orientation_summary(one, INPUTS.grid, mu) for mu in FRICTIONS]
        assert (number_of(row[0]), number_of(row[1])) == (one.roll_deg, one.pitch_deg)
        assert row[2:4] == [rounded(one.critical.last), rounded(one.critical.first)]
        assert [int(text.split()[0]) for text in row[5:]] == [summary.engaged for summary in summaries]
        assert [("undecided" in text) for text in row[5:]] == [summary.undecided > 0 for summary in summaries]


def test_the_sums_are_those_of_the_rows(page: Page) -> None:
    table = page.table("What engages at each friction")
    summaries = {mu: [orientation_summary(one, INPUTS.grid, mu) for one in orientations()] for mu in FRICTIONS}
    assert [number_of(text) for text in table.column("friction")] == list(FRICTIONS)
    for row, mu in zip(table.rows, FRICTIONS, strict=True):
        assert int(row[1].split()[0]) == sum(one.all_engage for one in summaries[mu])
        assert row[5] == f"{sum(one.engaged for one in summaries[mu])} of 50"
        for i, name in ((6, "torque"), (7, "tilt_deg"), (8, "shift")):
            largest = max(getattr(one, name) or 0.0 for one in summaries[mu])
            assert number_of(row[i]) == pytest.approx(largest, rel=6e-3)
    unsure = page.table("What is not known")
    assert unsure.column("undecided") == ["0", "2", "3"]
    assert unsure.column("why") == ["\N{EN DASH}", "2 ambiguous", "2 ambiguous, 1 bounded"]
    ends = page.table("How the paths end")
    assert [sum(map(int, row[1:])) for row in ends.rows] == [50, 50, 50]


def test_boundaries_that_are_not_narrowed_are_counted(page: Page) -> None:
    table = page.table("What is not known")
    for row, mu in zip(table.rows, FRICTIONS, strict=True):
        found = [one for each in orientations() for one in each.boundaries if one.mu == mu]
        wide = [one for one in found if one.to_deg - one.from_deg > INPUTS.phase_tolerance_deg]
        assert [int(text) for text in row[4:]] == [len(found), len(wide)]


def test_the_worst_come_first(page: Page) -> None:
    table = page.table("The lowest critical frictions")
    lasts = [number_of(text) for text in table.column("engages up to")]
    assert lasts == sorted(lasts)
    assert table.rows[0][:2] == ["2", "\N{MINUS SIGN}2"]
    assert table.rows[0][5] == "undecided"
    failing = page.table("The orientations that fail even without friction")
    assert len(failing.rows) == 10
    assert failing.rows[0] == ["0", "1", "1", "0", "no snap"]


def test_orientations_of_which_nothing_is_known_are_named() -> None:
    none = CriticalFriction(None, 0.0, 0.0, AssemblyOutcome.UNDECIDED, reenters=False)
    unknown = tuple(
        replace(
            one,
            critical=none,
            cells=tuple(
                replace(found, outcome=AssemblyOutcome.UNDECIDED) if found.mu == 0.0 else found for found in one.cells
            ),
        )
        for one in orientations()
    )
    page = Page(report_page(report_of(unknown)))
    (said,) = [text for text in page.paragraphs if text.startswith("Of 25 orientations nothing is known")]
    assert said.count("roll") == 12
    assert "undecided, the first 12 of which are: roll" in said
    assert all(text for text in page.paragraphs)


def test_the_path_in_detail_is_that_of_the_pose() -> None:
    page = Page(report_page(example_report(chosen=ASKED, unit=LengthUnit.MILLIMETRE)))
    document = assembly_document(path(0.0, -2.0, 180.0), LengthUnit.MILLIMETRE, 25.4)
    margins, energy, travel = document["margins"], document["energy"], document["travel"]
    assert margins is not None
    assert energy is not None
    assert travel is not None
    table = page.table("Margins of the outcome")
    shown = dict(zip(table.column("margin"), table.column("value"), strict=True))
    assert shown["play"] == f"{rounded(margins['play'])} mm"
    assert shown["lead"] == f"{rounded(100.0 * (margins['lead'] or 0.0))} %"
    assert set(shown) == set(margins)
    energies = page.table("Where the energy of the path went")
    assert energies.column("energy (N mm)") == [rounded(value) for value in energy.values() if isinstance(value, float)]
    assert any(f"{rounded(travel['torque'])} N mm of torque" in text for text in page.paragraphs)
    falls = [event for event in document["events"] if event["kind"] == "fall"]
    events = page.table("Falls and other events")
    drops = [row[3] for row in events.rows if row[0] == "fall"]
    assert drops == [rounded(event["drop"]) for event in falls]
    assert any("The bolt engages" in text for text in page.paragraphs)


def test_a_bolt_that_does_not_settle_has_no_curves() -> None:
    page = Page(report_page(report_of(orientations())))
    assert any("The bolt does not settle there" in text for text in page.paragraphs)
    assert len(page.named("figure")) == len(FRICTIONS) + 1


def test_device_and_pair_are_in_both_units(page: Page) -> None:
    device = page.table("The device")
    assert device.headings == ["quantity", "in millimetres", "in inches"]
    assert [number_of(text) for text in device.rows[0][1:]] == [20.0, 508.0]
    pair = page.table("The pair")
    for name, inches, millimetres in pair.rows:
        assert number_of(millimetres) == pytest.approx(25.4 * number_of(inches), rel=1e-5), name
    lengths = dict(zip(pair.column("dimension"), pair.column("in inches"), strict=True))
    assert number_of(lengths["pitch diameter of the bolt"]) == INPUTS.pair.fit.bolt_pitch_diameter


def test_the_whole_stiffness_of_a_device_is_shown_where_four_numbers_are_not_enough() -> None:
    device = INPUTS.device
    rows = [list(row) for row in device.stiffness]
    rows[0][4] = rows[4][0] = -12.5
    coupled = replace(device, stiffness=tuple(map(tuple, rows)))
    report = replace(report_of(orientations()), inputs=replace(INPUTS, device=coupled))
    page = Page(report_page(report))
    (table, other) = [table for table in page.tables if table.caption.startswith("Stiffness in N")]
    assert table.rows[0][5] == "\N{MINUS SIGN}12.5"
    assert other.rows[0][1] == rounded(500.0 / 25.4)
    assert not any(row[0].startswith("lateral stiffness") for row in page.table("The device").rows)
    assert any("stiffness = [[" in text for text in page.code)


def test_every_figure_has_a_text_alternative_and_a_caption(page: Page) -> None:
    pictures = page.named("svg")
    assert len(pictures) == len(page.named("figure")) == len(page.captions) == len(FRICTIONS) + 1 + 6
    assert all(one["role"] == "img" and len(one["aria-label"] or "") > 30 for one in pictures)
    assert all(len(caption) > 10 for caption in page.captions)


def test_every_table_has_a_caption_and_says_what_heads_what(page: Page) -> None:
    assert len(page.tables) >= 9
    assert all(table.caption and len({len(row) for row in [table.headings, *table.rows]}) == 1 for table in page.tables)
    assert {one.get("scope") for one in page.named("th")} == {"col", "row"}


def test_it_repeats_hashes_versions_and_the_date(page: Page) -> None:
    values = dict(page.table("What the numbers hang on").rows)
    assert values["input hash of the map"] == INPUTS.sha256
    assert values["content hash of the map"] == map_sha256(orientations())
    assert values["version of threadstate and its code"] == INPUTS.code_version
    assert values["version of numpy"] == "2"
    assert values["date"] == DATE.isoformat()
    assert values["frictions of the map"] == ", ".join(map(exact, FRICTIONS))


def test_the_same_report_is_the_same_text(text: str) -> None:
    assert report_page(example_report()) == text
    assert report_page(example_report(title="Another")) != text


def test_whatever_a_user_names_is_text() -> None:
    report = example_report(title=HOSTILE)
    pair = replace(INPUTS.pair, designation="<b>&'\"", fit=replace(INPUTS.pair.fit, name="</p><script>"))
    page = Page(report_page(replace(report, inputs=replace(INPUTS, pair=pair))))
    assert page.title == HOSTILE
    assert page.table("The pair").caption == "The pair: <b>&'\""
    assert not page.named("script")
    assert not page.named("b")
    assert not page.named("img")
    assert not [name for _, one in page.elements for name in one if name.startswith("on")]
    assert any(HOSTILE.replace("'", "'\"'\"'") in code for code in page.code)


def test_nothing_is_fetched(text: str, page: Page) -> None:
    assert "://" not in text
    assert "@import" not in text
    assert set(re.findall(r"url\((.)", text)) == {"#"}
    assert {(one.get("href") or "")[:1] for tag, one in page.elements if tag in ("a", "link")} == {"#", "d"}
    assert not [one for _, one in page.elements if "src" in one or "style" in one]
    policy = next(one["content"] or "" for one in page.named("meta") if "http-equiv" in one)
    assert "default-src 'none'" in policy
    assert not page.named("script")
