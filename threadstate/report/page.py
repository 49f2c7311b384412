"""A report as one HTML page, which needs no script and fetches nothing: the same report gives the same text."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

from threadstate.numbers import number_text
from threadstate.report import repeat
from threadstate.report.contents import Report
from threadstate.report.device_section import device_section
from threadstate.report.html import code_block, items, paragraph, section, table
from threadstate.report.map_section import map_section, orientations_section, worst_section
from threadstate.report.path_section import path_section
from threadstate.report.style import STYLE
from threadstate.report.words import answer, counted, exact, friction_words, reasons, turning

POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"


def report_page(report: Report) -> str:
    """The whole page."""
    sections = [
        ("answer", "The answer", [paragraph(text, "answer") for text in answer(report)]),
        ("device", "The device and the pair", list(device_section(report))),
        ("map", "The success map", list(map_section(report))),
        ("worst", "The worst approaches", list(worst_section(report))),
        ("path", "One path in detail", list(path_section(report))),
        ("sure", "How sure this is", list(_sure(report))),
        ("repeat", "How to repeat it", list(_repeat(report))),
        ("orientations", "Every orientation", list(orientations_section(report))),
    ]
    links = "".join(f'<li><a href="#{name}">{heading}</a></li>' for name, heading, _ in sections)
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en">',
            "<head>",
            '<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta name="referrer" content="no-referrer">',
            '<link rel="icon" href="data:,">',
            f"<title>{escape(report.title)}</title>",
            f"<style>{STYLE}</style>",
            "</head>",
            "<body>",
            "<main>",
            "<header>",
            f"<h1>{escape(report.title)}</h1>",
            paragraph(_subtitle(report), "faint"),
            f'<nav aria-label="Sections"><ul>{links}</ul></nav>',
            "</header>",
            *(section(name, heading, parts) for name, heading, parts in sections),
            "</main>",
            "</body>",
            "</html>",
            "",
        ]
    )


def _subtitle(report: Report) -> str:
    """What the report is of, and its date."""
    inputs = report.inputs
    return (
        f"{inputs.pair.designation}, {inputs.pair.fit.name}. The hand {turning(inputs.strategy, inputs.device)} "
        f"({inputs.strategy.value}). {report.date.isoformat()}."
    )


def _sure(report: Report) -> Iterator[str]:
    """What is certified, what is searched, and what is not known."""
    inputs = report.inputs
    yield paragraph(
        "Everything here is computed from the geometry of rigid parts, the stiffness of the device and one "
        "coefficient of friction for all contacts. Nothing was measured on a machine."
    )
    yield items(
        [
            "Certified at the end of each path with an outcome: no overlap of the parts above 1e-8 of the nominal "
            "radius along both edges, by bounds; contact forces that push, lie in their friction cones and balance "
            "device and push to 1e-9 of the push. Overlaps of thread with thread are searched for, densely, not "
            "excluded by bounds.",
            "Followed, not certified: the way to that end. Its equilibria are at most 2° of phase apart, with "
            "friction 1°, and a step that energy does not explain is halved.",
            "Declared: where a bolt comes to rest after a fall. No law of slow motion fixes it; it is the steepest "
            "descent, and with friction a flow against the forces that nothing balances.",
            f"Boundaries along the starting phase are narrowed to {exact(inputs.phase_tolerance_deg)}°, the critical "
            f"friction to {exact(inputs.mu_tolerance)}, where both ends have a certain outcome. Two starting phases "
            "that end alike are not looked between, nor are two orientations: a window narrower than the grid can be "
            "missed.",
            "The two paths beside a boundary end so with half the step, too; one that does not is undecided, and "
            "step dependent.",
            "That the bolt engages at every friction below a critical one is not proved: only those that were "
            f"computed are known.{_reentering(report)}",
            f"A path with more than {inputs.point_limit:,} points in one turn is not followed to its end. It is "
            "undecided, and bounded.",
        ]
    )
    yield table(
        "What is not known, by friction",
        ("friction", "paths", "undecided", "why", "boundaries of outcome", "of these not narrowed"),
        [
            (
                exact(part.mu),
                str(part.paths),
                str(part.undecided_paths),
                reasons(part),
                *map(str, _boundaries(report, part.mu)),
            )
            for part in report.parts
        ],
        sentences={3},
    )
    yield paragraph(
        "The documentation of threadstate has the rest: docs/success.md (maps), docs/device.md (the device, "
        "outcomes, flags), docs/forces.md (the model), docs/certificate.md (the contact search), "
        "docs/paths-checked.md (paths beside half the step).",
        "faint",
    )


def _reentering(report: Report) -> str:
    count = sum(one.critical.reenters for one in report.orientations)
    return f" At {counted(count, 'orientation')} the bolt engages again at a friction above." if count else ""


def _boundaries(report: Report, mu: float) -> tuple[int, int]:
    """How many boundaries of outcome there are at a friction, and how many of them are wider than the tolerance."""
    found = [boundary for one in report.orientations for boundary in one.boundaries if boundary.mu == mu]
    tolerance = report.inputs.phase_tolerance_deg
    return len(found), sum(boundary.to_deg - boundary.from_deg > tolerance for boundary in found)


def _repeat(report: Report) -> Iterator[str]:
    """The files, the command, hashes and versions."""
    inputs = report.inputs
    yield paragraph("This command computes the map, unless its file is there already, and writes this page again.")
    yield code_block(repeat.command(report), "The command")
    if not repeat.is_default(inputs.device):
        yield paragraph(f"The device, as the file {repeat.DEVICE_FILE}:")
        yield code_block(repeat.device_toml(inputs.device), "The file of the device")
    if not repeat.is_in_catalogue(inputs.pair):
        yield paragraph(f"The pair, as the file {repeat.PAIR_FILE}:")
        yield code_block(repeat.pair_toml(report), "The file of the pair")
    yield table(
        "What the numbers hang on",
        ("name", "value"),
        [
            ("input hash of the map", inputs.sha256),
            ("content hash of the map", report.content_sha256),
            ("version of threadstate and its code", inputs.code_version),
            *((f"version of {name}", version) for name, version in report.libraries),
            ("frictions of the map", ", ".join(map(number_text, inputs.frictions))),
            ("date", report.date.isoformat()),
        ],
        words={0, 1},
    )
    yield paragraph(
        "The same inputs, code and date give the same page, byte for byte. The path in detail was computed "
        f"{friction_words(report.chosen.mu)}, apart from the map."
    )
