"""One path of a report: how it ends and by what margins, its curves, its events, its energies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from threadstate.device.assembly_document import AssemblyDocument, AssemblyEventDocument
from threadstate.device.assembly_model import PathEventKind
from threadstate.report.chart_svg import alternative, chart_svg
from threadstate.report.contents import Report
from threadstate.report.curves import charts_of, course_of, marks_of
from threadstate.report.html import figure, figures, paragraph, table
from threadstate.report.words import FAILURES, NEWTON, counted, exact, friction_words, listed, name_of, rounded

CONTACT_CHANGES = (PathEventKind.GAINED, PathEventKind.LOST, PathEventKind.MOVED)
MOST_EVENTS = 30

MARGINS = {
    "lead": ("%", "by how much better than within 5 % the height follows the lead over the last 90°"),
    "play": ("{unit}", "how far inside the axial play in phase the last height is"),
    "tilt": ("deg", "how far the last tilt is below what the play allows"),
    "torque": ("F r", "how far the largest torque stays below its limit of 20 F r: push times nominal radius"),
    "offset": ("{unit}", "how far the origin stayed from slipping off the nut"),
    "snap": ("{unit}", "by how much the snap is deeper than it has to be"),
}
ENERGIES = {
    "work": "work of the hand",
    "push": "work of the push",
    "elastic": "change of the elastic energy",
    "friction": "lost by friction",
    "falls": "lost in falls",
    "balance": "left over: the error of the sum",
}


def path_section(report: Report) -> Iterator[str]:
    """The path that was chosen."""
    chosen, path, unit = report.chosen, report.path, report.unit
    yield paragraph(chosen.why)
    yield paragraph(
        f"Commanded are roll {exact(chosen.roll_deg)}°, pitch {exact(chosen.pitch_deg)}° and phase "
        f"{rounded(chosen.phase_deg, 6)}°, {friction_words(chosen.mu)}. {_outcome(path)}"
    )
    if not path["path"]["phase"]:
        return
    margins = [
        _margin(name, value, unit)
        for name, value in (path["margins"] or {}).items()
        if value is None or isinstance(value, float)
    ]
    yield table(
        "Margins of the outcome; positive where a rule holds, a dash where it was not asked",
        ("margin", "value", "meaning"),
        margins,
        words={0},
        sentences={2},
    )
    travel = path["travel"]
    if travel is not None:
        yield paragraph(
            f"Along the way the path asks of the device at most {rounded(travel['torque'])} {NEWTON}{unit} of torque, "
            f"{rounded(travel['tilt'])}° of tilt and {rounded(travel['shift'])} {unit} of shift."
        )
    yield from _curves(path)
    yield from _events(path, unit)
    energies = [
        (ENERGIES[name], rounded(value)) for name, value in (path["energy"] or {}).items() if isinstance(value, float)
    ]
    yield table("Where the energy of the path went", ("part", f"energy ({NEWTON}{unit})"), energies, words={0})


def _margin(name: str, value: float | None, unit: str) -> tuple[str, str, str]:
    of, meaning = MARGINS[name]
    if value is None:
        return name, rounded(None), meaning
    return name, f"{rounded(100.0 * value if of == '%' else value)} {of.format(unit=unit)}", meaning


def _outcome(path: AssemblyDocument) -> str:
    flags = f", flagged {listed([name_of(flag) for flag in path['flags']])}" if path["flags"] else ""
    if not path["path"]["phase"]:
        return f"The bolt does not settle there: it {FAILURES[path['outcome']]}{flags}."
    return f"The bolt {FAILURES[path['outcome']]}{flags}."


def _curves(path: AssemblyDocument) -> Iterator[str]:
    """The curves, with what is marked on all of them."""
    course = course_of(path["path"])
    marks = marks_of(path, course)
    falls = sum(mark.kind is PathEventKind.FALL for mark in marks)
    shaded = " Shaded: the hand turns back, clockwise in a right-hand thread." if course.legs[-1] else ""
    yield paragraph(
        f"The curves follow the phase of the hand from left to right as it turns.{shaded} A triangle with a broken "
        f"line is a fall, of which there {'is' if falls == 1 else 'are'} {falls}."
    )
    yield figures([figure(chart_svg(chart, course, marks), alternative(chart)) for chart in charts_of(path)])


def _events(path: AssemblyDocument, unit: str) -> Iterator[str]:
    """All events but changes of contacts; of many the ones with the deepest drop."""
    events = [event for event in path["events"] if event["kind"] not in CONTACT_CHANGES]
    changes = Counter(event["kind"] for event in path["events"])
    texts = [f"{changes[kind]} {name_of(kind.value)}" for kind in CONTACT_CHANGES]
    shown = _deepest(events)
    if shown:
        yield table(
            "Falls and other events, in their order"
            + ("" if len(shown) == len(events) else f": {len(shown)} of {len(events)}"),
            (
                "event",
                "between phase (deg)",
                "and (deg)",
                f"drop ({unit})",
                f"way ({unit})",
                f"energy lost ({NEWTON}{unit})",
            ),
            [
                (
                    name_of(event["kind"].value),
                    *(rounded(event[key], 7) for key in ("from_phase", "phase")),
                    *(rounded(event[key]) for key in ("drop", "way", "energy")),
                )
                for event in shown
            ],
            words={0},
        )
    yield paragraph(
        f"Contacts change {counted(sum(changes[kind] for kind in CONTACT_CHANGES), 'time')}: {listed(texts)}."
    )


def _deepest(events: Sequence[AssemblyEventDocument]) -> list[AssemblyEventDocument]:
    order = sorted(range(len(events)), key=lambda i: -abs(events[i]["drop"] or 0.0))
    return [events[i] for i in sorted(order[:MOST_EVENTS])]
