"""A success map that is made up, with all that a report tells apart, and the parts of a page."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, field
from functools import cache, partial
from html.parser import HTMLParser

from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath
from threadstate.device.model import SettledFlag, default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.report.contents import ChosenPath, Report, default_path, made_report
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.search import mapped_cells
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import LengthUnit

DATE = datetime.date(2026, 1, 31)
GRID = Grid(2.0, 1.0, 180.0)
FRICTIONS = (0.0, 0.1, 0.2)
INPUTS = SuccessInputs(quarter_twenty_unc(), default_device(), Strategy.CCW_THEN_CW, GRID, FRICTIONS)
FIRST_TO_FAIL = (1.0, -1.0, 180.0, 0.13)
"""Roll, pitch and phase of the path that fails at the least friction, and that friction; without undecided ones."""


def cell(roll_deg: float, pitch_deg: float, phase_deg: float, mu: float) -> Cell:
    """A path of the made-up map: bolts that lean backwards never engage, others up to a friction of their own."""
    torque = 0.1 + mu + 0.01 * abs(roll_deg) + 0.001 * phase_deg / 180.0

    def ending(outcome: AssemblyOutcome, *flags: SettledFlag) -> Cell:
        return Cell(phase_deg, mu, outcome, flags, False, torque, 2.0 * torque, 0.01 * torque, phase_deg + 90.0)

    if pitch_deg > 0.0:
        return ending(AssemblyOutcome.NO_SNAP)
    if (roll_deg, pitch_deg) == (2.0, -2.0) and mu > 0.05:
        return ending(AssemblyOutcome.UNDECIDED, SettledFlag.AMBIGUOUS)
    if (roll_deg, pitch_deg, phase_deg) == (-2.0, -2.0, 180.0) and mu > 0.15:
        return Cell(phase_deg, mu, AssemblyOutcome.UNDECIDED, (), True, None, None, None, None)
    if (roll_deg, pitch_deg, phase_deg) == FIRST_TO_FAIL[:3] and mu > FIRST_TO_FAIL[3]:
        return ending(AssemblyOutcome.IDLE)
    return ending(AssemblyOutcome.ENGAGED)


@cache
def orientations() -> tuple[OrientationMap, ...]:
    """The made-up map, with boundaries and critical frictions as the search finds them."""
    found = []
    for index in range(GRID.orientation_count):
        one = GRID.orientation(index)
        compute = partial(cell, one.roll_deg, one.pitch_deg)
        parts = mapped_cells(
            compute, lambda _: True, GRID.phases_deg, FRICTIONS, INPUTS.phase_tolerance_deg, INPUTS.mu_tolerance
        )
        found.append(OrientationMap(index, one.roll_deg, one.pitch_deg, *parts))
    return tuple(found)


@cache
def path(roll_deg: float, pitch_deg: float, phase_deg: float, mu: float = 0.0) -> AssemblyPath:
    """A path of the default device, computed once in a run."""
    # Loads the kernels: tests of words and counts do without.
    from threadstate.device.assemble import assemble_pose

    return assemble_pose(INPUTS.pair, roll_deg, pitch_deg, phase_deg, INPUTS.device, INPUTS.strategy, mu=mu)


def example_report(
    title: str = "A wrist", unit: LengthUnit = LengthUnit.INCH, chosen: ChosenPath | None = None
) -> Report:
    """A report of the made-up map with a real path without friction; by default that of the default pose."""
    shown = chosen or default_path(INPUTS, orientations())
    return made_report(
        INPUTS,
        orientations(),
        shown,
        path(shown.roll_deg, shown.pitch_deg, shown.phase_deg),
        unit=unit,
        title=title,
        date=DATE,
        libraries=[("numpy", "2")],
    )


@dataclass
class Table:
    """A table of a page: its caption, its headings, the texts of its rows."""

    caption: str = ""
    headings: list[str] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)

    def column(self, heading: str) -> list[str]:
        """The texts of a column."""
        at = self.headings.index(heading)
        return [row[at] for row in self.rows]


class Page(HTMLParser):
    """What a page holds."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[Table] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.captions: list[str] = []
        self.paragraphs: list[str] = []
        self.code: list[str] = []
        self.title = ""
        self._open: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """An element begins."""
        self.elements.append((tag, dict(attributes)))
        self._open.append(tag)
        if tag == "table":
            self.tables.append(Table())
        elif tag == "tr" and "tbody" in self._open:
            self.tables[-1].rows.append([])
        elif tag in ("th", "td"):
            (self.tables[-1].rows[-1] if "tbody" in self._open else self.tables[-1].headings).append("")
        elif tag == "figcaption":
            self.captions.append("")
        elif tag in ("p", "li"):
            self.paragraphs.append("")
        elif tag == "pre":
            self.code.append("")
        if tag in ("meta", "link"):
            self._open.pop()

    def handle_endtag(self, tag: str) -> None:
        """An element ends; it is the last one that is open."""
        assert self._open.pop() == tag

    def handle_data(self, text: str) -> None:
        """Text of the innermost element; a space that does not break is a space."""
        text = text.replace("\N{NO-BREAK SPACE}", " ")
        if "caption" in self._open:
            self.tables[-1].caption += text
        elif "th" in self._open or "td" in self._open:
            line = self.tables[-1].rows[-1] if "tbody" in self._open else self.tables[-1].headings
            line[-1] += text
        elif "figcaption" in self._open:
            self.captions[-1] += text
        elif "pre" in self._open:
            self.code[-1] += text
        elif self._open[-1:] in (["p"], ["li"], ["a"]):
            self.paragraphs[-1] += text
        elif self._open[-2:] == ["head", "title"]:
            self.title += text

    def table(self, beginning: str) -> Table:
        """The table whose caption begins so."""
        (found,) = [table for table in self.tables if table.caption.startswith(beginning)]
        return found

    def named(self, tag: str) -> list[dict[str, str | None]]:
        """The attributes of all elements of a kind."""
        return [attributes for name, attributes in self.elements if name == tag]


def number_of(text: str) -> float:
    """The number that a text begins with."""
    return float(text.partition(" ")[0].replace("\N{MINUS SIGN}", "-"))
