"""Limits of standard threads against those that are published, and designations as people write them."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.standards import acme, buttress, metric, trapezoidal, unified, whitworth
from threadstate.thread.standards.designation import found_threads, standard_thread, standard_threads
from threadstate.thread.standards.document import standard_thread_document
from threadstate.thread.standards.limits import Limits, rounded
from threadstate.thread.standards.pairs import standard_pair
from worker.cli import run_command_line

PUBLISHED = Path(__file__).parent / "published"
Row = tuple[str, list[float | None], list[float | None]]


def rows(name: str) -> Iterator[list[str]]:
    """The rows of a table; a plus sign in a size stands for a blank."""
    for line in (PUBLISHED / f"{name}.txt").read_text().splitlines():
        if not line.startswith("#"):
            yield [part.replace("+", " ") for part in line.split()]


def numbers(texts: list[str]) -> list[float | None]:
    return [None if text == "-" else float(text) for text in texts]


def of_bolt(limits: Limits) -> list[float | None]:
    return [bound for one in (limits.major, limits.pitch, limits.minor) for bound in (one.greatest, one.least)]


def of_nut(limits: Limits) -> list[float | None]:
    return [bound for one in (limits.major, limits.pitch, limits.minor) for bound in (one.least, one.greatest)]


def unified_rows() -> Iterator[Row]:
    by_name = {one.name: one for series in unified.Series for one in unified.sizes(series)}
    for size, _, tolerance, *values in rows("unified"):
        if tolerance.endswith("A"):
            found = of_bolt(unified.bolt_limits(by_name[size], tolerance))[:4]
        else:
            _, _, pitch_min, pitch_max, minor_min, minor_max = of_nut(unified.nut_limits(by_name[size], tolerance))
            found = [minor_min, minor_max, pitch_min, pitch_max]
        yield f"{size} {tolerance}", numbers(values), found


def metric_rows() -> Iterator[Row]:
    for size, tolerance, *values in rows("metric"):
        diameter, pitch = map(float, size.removeprefix("M").split("x"))
        if tolerance[-1].islower():
            found = of_bolt(metric.bolt_limits(diameter, pitch, tolerance))
        else:
            _, _, pitch_min, pitch_max, minor_min, minor_max = of_nut(metric.nut_limits(diameter, pitch, tolerance))
            found = [minor_min, minor_max, pitch_min, pitch_max]
        yield f"{size} {tolerance}", numbers(values), found


def metric_minor_rows() -> Iterator[Row]:
    for pitch, *values in rows("metric_minor"):
        grades = range(4, 4 + len(values))
        yield pitch, numbers(values), [metric.minor_tolerance_um(float(pitch), one) / 1000.0 for one in grades]


def acme_rows() -> Iterator[Row]:
    by_name = {one.name: one for one in acme.sizes()}
    for size, tolerance, part, *values in rows("acme"):
        limits = acme.screw_limits if part == "screw" else acme.nut_limits
        found = limits(by_name[size], tolerance)
        yield f"{size} {tolerance}", numbers(values), of_bolt(found) if part == "screw" else of_nut(found)


def trapezoidal_rows() -> Iterator[Row]:
    for diameter, pitch, *values in rows("trapezoidal"):
        bolt = of_bolt(trapezoidal.bolt_limits(float(diameter), float(pitch), "7e"))
        major, _, *rest = of_nut(trapezoidal.nut_limits(float(diameter), float(pitch), "7H"))
        yield f"Tr {diameter}x{pitch}", numbers(values), [*bolt, major, *rest]


def trapezoidal_10c_rows() -> Iterator[Row]:
    for diameter, pitch, *values in rows("trapezoidal_10c"):
        below = trapezoidal.DEVIATION_C_UM[float(pitch)]
        width = metric.pitch_tolerance_um(float(diameter), float(pitch), 10, nut=False)
        minor = round(1000.0 * trapezoidal.minor_tolerance_mm(width / 1000.0, below / 1000.0), 6)
        found: list[float | None] = [trapezoidal.CREST_4_UM[float(pitch)], below, below + width, minor]
        yield f"{diameter}, {pitch}", numbers(values), found


def buttress_rows() -> Iterator[Row]:
    for threads, *values in rows("buttress"):
        of_ranges = [buttress.ButtressSize("", greatest, int(threads)) for greatest in buttress.RANGES[1:]]
        yield threads, numbers(values), [buttress.tolerance(one, "2") for one in of_ranges[: len(values)]]


def buttress_form_rows() -> Iterator[Row]:
    """From the constants that the limits are made of, the angles of the flanks, and the fillet of a pair's root."""
    tangents = sum(math.tan(math.radians(one)) for one in (buttress.LOAD_FLANK_DEG, buttress.CLEARANCE_FLANK_DEG))
    height, sharp, beyond = buttress.HEIGHT, 1.0 / tangents, buttress.ROOT_BEYOND / 2.0
    root = standard_pair("1/2-16 BUTT").form.bolt_root_fillet
    heights = [height, sharp, (sharp - height) / 2.0, height + beyond, (sharp - height) / 2.0 - beyond]
    for threads, *values in rows("buttress_form"):
        ratios = [*heights, root, 0.5 - height / 2.0 * tangents]
        yield threads, numbers(values), [rounded(ratio / float(threads), 4) for ratio in ratios]


def whitworth_rows() -> Iterator[Row]:
    by_name = {(str(series), one.name): one for series in whitworth.Series for one in whitworth.sizes(series)}

    def widths(limits: Limits) -> list[float]:
        major_max, major_min, pitch_max, pitch_min, minor_max, minor_min = (one or 0.0 for one in of_bolt(limits))
        return [round(one, 4) for one in (major_max - major_min, pitch_max - pitch_min, minor_max - minor_min)]

    for series, name, *values in rows("whitworth"):
        size = by_name[series, name]
        close, medium, free = (widths(whitworth.bolt_limits(size, one)) for one in whitworth.BoltClass)
        nut = whitworth.nut_limits(size, "medium")
        found = [nut.pitch.least, nut.minor.least, close[1], medium[1], free[1], medium[0], medium[2]]
        found += [widths(nut)[2], whitworth.allowance(size, whitworth.BoltClass.MEDIUM)]
        yield f"{series} {name}", numbers(values), found


TABLES = {
    "unified": (unified_rows, 374),
    "metric": (metric_rows, 249),
    "metric_minor": (metric_minor_rows, 27),
    "acme": (acme_rows, 88),
    "trapezoidal": (trapezoidal_rows, 77),
    "trapezoidal_10c": (trapezoidal_10c_rows, 143),
    "whitworth": (whitworth_rows, 74),
    "buttress": (buttress_rows, 19),
    "buttress_form": (buttress_form_rows, 19),
}


@pytest.mark.parametrize("name", TABLES)
def test_every_published_value_is_met(name: str) -> None:
    table, count = TABLES[name]
    compared = 0
    for where, published, found in table():
        for number, (expected, value) in enumerate(zip(published, found, strict=True)):
            if expected is not None:
                assert value == expected, f"{where}, number {number}"
                compared += 1
    assert compared == count


def test_all_sizes_have_limits_in_order() -> None:
    found = list(standard_threads())
    assert len({one.designation for one in found}) == len(found) == 501
    for one in found:
        for part in (one.bolt, one.nut):
            for diameter in (part.major, part.pitch, part.minor):
                if diameter.least is not None and diameter.greatest is not None:
                    assert 0.0 < diameter.least < diameter.greatest, one.designation
        assert one.bolt.pitch.greatest is not None
        assert one.nut.pitch.least is not None
        assert one.bolt.pitch.greatest <= one.nut.pitch.least
        assert standard_thread(one.designation) == one
        assert standard_thread(one.designation.lower()).nominal_diameter == one.nominal_diameter


def test_the_default_pair_is_its_standards_at_maximum_material() -> None:
    pair, found = quarter_twenty_unc(), standard_thread("1/4-20 UNC-2A/2B")
    assert (pair.unit, pair.nominal_diameter, pair.thread_pitch) == (found.unit, 0.25, found.thread_pitch)
    fit = pair.fit
    assert [fit.bolt_major_diameter, fit.bolt_pitch_diameter] == [found.bolt.major.greatest, found.bolt.pitch.greatest]
    assert fit.bolt_minor_diameter == found.bolt.minor.greatest
    nut = [found.nut.major.least, found.nut.pitch.least, found.nut.minor.least]
    assert [fit.nut_major_diameter, fit.nut_pitch_diameter, fit.nut_minor_diameter] == nut


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("1/4-20 UNC", "1/4-20 UNC-2A/2B"),
        ("1/4-20 unc - 3a / 3b", "1/4-20 UNC-3A/3B"),
        ("1/4-20 UNC-3A", "1/4-20 UNC-3A/3B"),
        ("1/4-20 UNC-2B/1A", "1/4-20 UNC-1A/2B"),
        ("#6-32  UNC", "6-32 UNC-2A/2B"),
        ("1 1/8-7 UNC LH", "1 1/8-7 UNC-2A/2B LH"),
        ("M6", "M6x1-6g/6H"),
        ("m6X1-6G/6h", "M6x1-6h/6G"),
        ("M 6 x 1 - 6H/6g", "M6x1-6g/6H"),
        ("M6-4g6g/5H", "M6x1-4g6g/5H"),
        ("M8x1-6g", "M8x1-6g/6H"),
        ("M8x1-7H", "M8x1-6g/7H"),
        ("tr8x1.5-8e", "Tr 8x1.5-8e/7H"),
        ("1/4-16 Acme lh", "1/4-16 ACME-2G LH"),
        ("Tr 8x1.5LH-7e/7H", "Tr 8x1.5-7e/7H LH"),
        ("M6x1-LH", "M6x1-6g/6H LH"),
        ("M6 LH-6g", "M6x1-6g/6H LH"),
        ("1/4-16 ACME-3G/2G", "1/4-16 ACME-3G/2G"),
        ("1/2-10 stub acme", "1/2-10 STUB ACME-2G"),
        ("1/4-20 bsw-free/medium", "1/4-20 BSW-free/medium"),
        ("1/4-28 UNJF-3A/3B", "1/4-28 UNJF-3A/3B"),
        (".2500-28 UNJF", "1/4-28 UNJF-3A/3B"),
        ("0.190-32 unjf-3a", "10-32 UNJF-3A/3B"),
        (".1380-32 UNC-2A", "6-32 UNC-2A/2B"),
        ("1.125-7 UNC LH", "1 1/8-7 UNC-2A/2B LH"),
        ("MJ6", "MJ6x1-4h6h/4H5H"),
        ("MJ6x1 4h6h - 4H5H", "MJ6x1-4h6h/4H5H"),
        ("mj6 x 1-4H5H/4h6h", "MJ6x1-4h6h/4H5H"),
        ("MJ5x0.8-4h6h", "MJ5x0.8-4h6h/4H6H"),
        ("MJ6x1-4g6g LH", "MJ6x1-4g6g/4H5H LH"),
        ("M6 6g/6H", "M6x1-6g/6H"),
        ("2.5-8 BUTT-2A/2B", "2 1/2-8 BUTT-2A/2B"),
        ("1/2-16 butt", "1/2-16 BUTT-2A/2B"),
        ("1/2-16 Pull-Butt-3A", "1/2-16 BUTT-3A/3B"),
        ("2.500-8 PUSH-BUTT-2A-LH", "2 1/2-8 PUSH-BUTT-2A/2B LH"),
    ],
)
def test_a_designation_is_read_as_people_write_it(written: str, meant: str) -> None:
    assert standard_thread(written).designation == meant
    assert standard_thread(written).left_hand == meant.endswith("LH")


@pytest.mark.parametrize(
    ("written", "error", "valid"),
    [
        ("1/4-20", UnknownNameError, "1/4-20 UNC-2A/2B"),
        ("M6x3", UnknownNameError, "M6x1-6g/6H"),
        ("", UnknownNameError, "M6"),
        ("LH", UnknownNameError, "M6"),
        ("M6-6g/6H/6G", InvalidValueError, "classes of bolt and nut, such as 6g/6H"),
        ("M6-6g/", InvalidValueError, "classes of bolt and nut"),
        ("M6-6k", InvalidValueError, "e, f, g or h"),
        ("M6-6g/6K", InvalidValueError, "G or H"),
        ("M6-2g", InvalidValueError, "grades 3, 4, 5"),
        ("M6-5e7g", InvalidValueError, "e, f, g or h"),
        ("M6-tight", InvalidValueError, "a grade and a position"),
        ("M1.6-8g", InvalidValueError, "0.35 mm"),
        ("1/4-20 UNC-4A", InvalidValueError, "1A, 2A or 3A"),
        ("1/4-20 UNC-2A/4B", InvalidValueError, "1B, 2B or 3B"),
        ("1/4-16 ACME-5G", InvalidValueError, "2G, 3G, 4G of Acme"),
        ("1/4-16 STUB ACME-3G", InvalidValueError, "2G of Stub Acme"),
        ("Tr 8x1.5-4e", InvalidValueError, "grade 7, 8 or 9"),
        ("1/4-20 BSW-loose", InvalidValueError, "close, medium, free"),
        ("1/4-28 UNJF-2A", InvalidValueError, "3A for a bolt with a UNJ thread"),
        ("1/4-28 UNJF-3A/2B", InvalidValueError, "3B for a nut with a UNJ thread"),
        ("MJ6x1-4k6k", InvalidValueError, "e, f, g or h"),
        ("MJ6x1-4h6h/4H9H", InvalidValueError, "4, 5, 6, 7, 8 of the crest"),
        ("1/2-16 BUTT-1A", InvalidValueError, "2A or 3A for a screw with a buttress thread"),
        ("1/2-16 PUSH-BUTT-2A/1B", InvalidValueError, "2B or 3B for a nut with a buttress thread"),
        ("1/2-16 BUTT-2", InvalidValueError, "2A or 3A for a screw with a buttress thread"),
        ("1/2-17 BUTT", UnknownNameError, "1/4-20 UNC-2A/2B"),
        ("0.3-20 UNC", UnknownNameError, "1/4-20 UNC-2A/2B"),
    ],
)
def test_what_is_no_designation_is_refused(written: str, error: type[Exception], valid: str) -> None:
    with pytest.raises(error, match="valid: ") as found:
        standard_thread(written)
    assert valid in str(found.value)


@pytest.mark.parametrize(
    ("written", "nut"),
    [("1/4-28 UNJF", (0.2152, None)), ("10-32 UNJF", (0.1596, None)), ("MJ6x1-4h6h/4H5H", (5.026, 5.216))],
)
def test_a_controlled_root_leaves_room_in_the_nut(written: str, nut: tuple[float, float | None]) -> None:
    """Minor diameters of nuts are 9/8 of the sharp triangle's height below the major one; that of UNJ has no limit."""
    found = standard_thread(written)
    plain = standard_thread(written.replace("J", ""))
    assert (found.nut.minor.least, found.nut.minor.greatest) == nut
    assert found.bolt.minor.greatest is not None
    assert found.nut.minor.least is not None
    assert plain.nut.minor.least is not None
    assert plain.nut.minor.least < found.nut.minor.least
    assert found.bolt.minor.greatest < found.nut.minor.least
    assert found.source != plain.source


def test_tolerances_of_the_pitch_diameter_grow_with_the_starts_of_a_trapezoidal_thread() -> None:
    def widths(starts: int) -> list[float]:
        found = standard_thread(f"Tr 8x1.5 {starts} starts")
        bounds = [(one.least, one.greatest) for one in (found.bolt.pitch, found.nut.pitch)]
        return [round(1000.0 * (greatest - least), 6) for least, greatest in bounds if least and greatest]

    assert [widths(starts) for starts in (1, 2, 3, 4)] == [[170, 224], [190, 251], [212, 280], [238, 314]]
    one, two = (standard_thread(f"Tr 8x1.5 {starts} starts") for starts in (1, 2))
    assert (one.bolt.major, one.nut.major, one.nut.minor) == (two.bolt.major, two.nut.major, two.nut.minor)
    assert one.bolt.pitch.greatest == two.bolt.pitch.greatest
    assert one.nut.pitch.least == two.nut.pitch.least


def test_a_search_finds_a_designation_or_words() -> None:
    assert found_threads(None) == list(standard_threads())
    assert [one.designation for one in found_threads("m6")] == ["M6x1-6g/6H"]
    assert [one.designation for one in found_threads("M6x1-4h/5H")] == ["M6x1-4h/5H"]
    fine = found_threads("1/4-32 unef")
    assert [one.designation for one in fine] == ["1/4-32 UNEF-2A/2B"]
    assert {one.form for one in found_threads("bs")} == {"Whitworth"}
    for nothing in ("M7x9", "", "  "):
        with pytest.raises(UnknownNameError):
            found_threads(nothing)


def test_the_command_prints_one_object_or_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["threads", "--search", "1/4-16 acme-2g", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["threads"]
    assert found == standard_thread_document(standard_thread("1/4-16 ACME"))
    assert list(found) == ["designation", "form", "unit", "thread_pitch", "bolt", "nut", "source"]
    assert found["bolt"] == {"major": [0.245, 0.25], "pitch": [0.2043, 0.2148], "minor": [0.1618, 0.1775]}
    assert run_command_line(["threads", "--search", "1/4-20 UNC", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["threads"]
    assert found["bolt"]["minor"] == [0.1802, 0.1894]
    assert run_command_line(["threads"]) == 0
    assert len(capsys.readouterr().out.splitlines()) > 501
    assert run_command_line(["threads", "--search", "M6-6k"]) != 0
    assert "tolerance class" in capsys.readouterr().err
