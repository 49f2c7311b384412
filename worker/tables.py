"""Text tables: number formats, and the tables of states and contacts."""

from __future__ import annotations

import math
import shutil
import sys
import textwrap
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from threadstate.numbers import number_text
from threadstate.state.model import ContactState
from threadstate.thread.pair import Pair, Part
from threadstate.units import LengthUnit, conversion_factor, scale_length
from worker.output import print_line

if TYPE_CHECKING:
    from threadstate.device.assembly_document import AssemblyDocument
    from threadstate.device.document import SettledDocument
    from threadstate.statics.extras import Extras
    from threadstate.statics.jamming_document import JammingDocument
    from threadstate.statics.solve import Statics
    from threadstate.thread.standards.designation import StandardThread
    from threadstate.thread.standards.limits import Diameter

_GAP = "  "
_INDENT = "      "
LEAST_WIDTH = 20
"""Minimum width to which words are wrapped."""

LENGTH_DECIMALS = {LengthUnit.INCH: 6, LengthUnit.MILLIMETRE: 5}
"""Decimals of a length in a table: finer than any measurement, coarser than round-off."""
ANGLE_DECIMALS = 6

OWN_DIMENSIONS = "dimensions of one's own"
"""Where no standard is the source of a pair."""
PAST_360 = "-> "
"""Stands before the end of an interval that goes on past phase 360."""


class Table:
    """A table without lines. A row is one line.

    Where the last column holds words, and the terminal is narrower than the table, these words go below their row.
    """

    def __init__(self, columns: Sequence[str], *, words_last: bool) -> None:
        self._rows: list[Sequence[str]] = [columns]
        self._words_last = words_last

    def add_row(self, *cells: str) -> None:
        """Add a row, one cell a column."""
        assert len(cells) == len(self._rows[0])
        self._rows.append(cells)

    def print(self) -> None:
        """Print the table, at the width of the terminal where there is one."""
        widths = [max(len(row[i]) for row in self._rows) for i in range(len(self._rows[0]))]
        available = terminal_width()
        if not self._words_last or available is None or sum(widths) + len(_GAP) * (len(widths) - 1) <= available:
            for row in self._rows:
                print_line(_line(row, widths))
            return
        for row in self._rows:
            print_line(_line(row[:-1], widths))
            width = max(available - len(_INDENT), LEAST_WIDTH)
            for line in textwrap.wrap(row[-1], width, break_long_words=False, break_on_hyphens=False):
                print_line(f"{_INDENT}{line}")


def table(*columns: str, words_last: bool = False) -> Table:
    """An empty table of these columns; ``words_last``: the last one holds words, of any length."""
    return Table(columns, words_last=words_last)


def terminal_width() -> int | None:
    """The width of the terminal in characters; None if stdout is not a terminal."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def angle(value: float | None) -> str:
    """An angle in degrees."""
    return "-" if value is None else _fixed(value, ANGLE_DECIMALS)


def phase(value: float | None) -> str:
    """A phase in degrees, in [0, 360)."""
    return "-" if value is None else _fixed(round(value, ANGLE_DECIMALS) % 360.0, ANGLE_DECIMALS)


def interval_end(start: float, end: float) -> str:
    """The phase at which an interval ends, in [0, 360), with a mark where the interval goes on past 360."""
    goes_on = round(end, ANGLE_DECIMALS) >= 360.0 > start
    return f"{PAST_360 if goes_on else ''}{phase(end)}"


def length(value: float | None, unit: LengthUnit, *, signed: bool = False) -> str:
    """A length in its unit, to the decimals of tables; 0 for what is less than half of the last one."""
    if value is None:
        return "-"
    rounded = round(value, LENGTH_DECIMALS[unit])
    return "0" if rounded == 0.0 else f"{rounded:{'+' if signed else ''}.{LENGTH_DECIMALS[unit]}f}"


def _fixed(value: float, decimals: int) -> str:
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return _GAP.join(cell.ljust(width) for cell, width in zip(cells, widths, strict=False)).rstrip()


def print_states(states: Sequence[ContactState], unit: LengthUnit, factor: float) -> None:
    """One row a state: pose, class, turns, lengths (multiplied by ``factor``, in ``unit``), flags."""
    rows = table(
        "roll", "pitch", "phase", "class", "lambda", "mu", f"drop ({unit})", "embedment", "pivot offset", "flags"
    )
    for state in states:
        rows.add_row(
            number_text(state.roll_deg),
            number_text(state.pitch_deg),
            f"{state.phase_deg % 360.0:.12g}",
            state.state_class.value,
            angle(state.lambda_deg),
            angle(state.mu_deg),
            length(scale_length(state.drop, factor), unit),
            length(scale_length(state.embedment, factor), unit),
            length(scale_length(state.pivot_offset, factor), unit),
            ", ".join(state.flags),
        )
    rows.print()


def print_contacts(state: ContactState, unit: LengthUnit, factor: float) -> None:
    """One row a contact: where it is (lengths multiplied by ``factor``, in ``unit``), between which features."""
    rows = table("stage", f"x ({unit})", "y", "z", "bolt region", "nut region", "features")
    for contact in state.contacts:
        rows.add_row(
            str(contact.stage),
            *(length(coordinate * factor, unit) for coordinate in contact.point),
            contact.bolt_region.value,
            contact.nut_region.value,
            contact.features.value,
        )
    rows.print()


def print_statics(statics: Statics, extras: Extras | None, unit: LengthUnit, factor: float) -> None:
    """What a load does to a state, a number a row, then the forces and what was requested beside them.

    Lengths are times ``factor``, in ``unit``.
    """
    roll, pitch, phase = map(number_text, statics.pose_deg)
    load = statics.load
    rows = table("", "")
    rows.add_row("roll, pitch, phase (deg)", f"{roll}, {pitch}, {phase}")
    rows.add_row("force (N)", _numbers(load.force))
    rows.add_row(f"moment (N {unit})", _numbers([factor * number for number in load.moment]))
    rows.add_row(f"about ({unit})", _numbers([factor * number for number in load.point or ()]))
    rows.add_row("mu", number_text(statics.mu))
    rows.add_row("verdict", f"{statics.verdict}{' (the solids overlap)' if statics.penetrating else ''}")
    rows.add_row("support margin", f"{statics.support_margin:.6f}")
    rows.add_row("holds from mu", _friction(statics.hold.value))
    rows.add_row("wedges from mu", _friction(statics.wedge.value))
    rows.add_row("turns counter-clockwise at", _effort(statics.turn_effort_ccw))
    rows.add_row("turns clockwise at", _effort(statics.turn_effort_cw))
    for force in statics.forces:
        rows.add_row(
            f"contact {force.contact} (N)", f"{force.normal:.6f} normal, {_numbers(force.tangential)} tangential"
        )
    if extras is not None:
        _add_extras(rows, extras, unit, factor)
    rows.print()


def print_settled(state: SettledDocument) -> None:
    """A settled state, a number a row, then its contact forces and the falls on the way."""
    unit = state["unit"]
    rows = table("", "")
    roll, pitch, phase = (number_text(state["roll"]), number_text(state["pitch"]), number_text(state["phase"]))
    rows.add_row("roll, pitch, phase (deg)", f"{roll}, {pitch}, {phase}")
    rows.add_row("outcome", ", ".join([state["outcome"], *state["flags"]]))
    if state["pose"] is not None and state["deviation"] is not None:
        rows.add_row(f"origin ({unit})", _numbers(state["pose"]["translation"]))
        rows.add_row(f"shift ({unit})", _numbers(state["deviation"]["shift"]))
        rows.add_row("rotation (deg)", _numbers(state["deviation"]["rotation"]))
        rows.add_row(f"elastic energy (N {unit})", f"{state['elastic_energy']:.6f}")
    for contact in state["contacts"]:
        rows.add_row(f"{contact['features']} (N)", f"{_numbers(contact['force'])} at {_numbers(contact['point'])}")
    for fall in state["falls"]:
        rows.add_row(f"fall at {fall['push']:.6f} N ({unit})", f"drop {fall['drop']:.6f}, way {fall['way']:.6f}")
    rows.print()


def print_assembly(path: AssemblyDocument) -> None:
    """A path, a number a row: how it ends, its margins and energies, then its events."""
    unit = path["unit"]
    rows = table("", "")
    roll, pitch, phase = (number_text(path["roll"]), number_text(path["pitch"]), number_text(path["phase"]))
    rows.add_row("roll, pitch, phase (deg)", f"{roll}, {pitch}, {phase}")
    rows.add_row("strategy, mu", f"{path['strategy']}, {number_text(path['mu'])}")
    rows.add_row("outcome", ", ".join([path["outcome"], *path["flags"]]))
    if path["margins"] is not None and path["energy"] is not None and path["travel"] is not None:
        for name, value in path["margins"].items():
            rows.add_row(f"margin, {name}", "" if value is None else f"{value:.6f}")
        for name, energy in path["energy"].items():
            rows.add_row(f"energy, {name} (N {unit})", f"{energy:.6f}")
        travel = path["travel"]
        rows.add_row("torque, tilt, shift", _numbers([travel["torque"], travel["tilt"], travel["shift"]]))
        origin = path["path"]["pose"][-1]["translation"]
        rows.add_row(f"last origin ({unit})", f"{_numbers(origin)} at {path['path']['phase'][-1]:.2f} deg")
    for event in path["events"]:
        what: list[str] = [text for text in (event["features_before"], event["features"]) if text is not None]
        if event["drop"] is not None and event["way"] is not None:
            what.append(f"drop {event['drop']:.6f}, way {event['way']:.6f}")
        rows.add_row(f"{event['kind']} at {event['phase']:.2f} deg", " to ".join(what))
    rows.print()


def _add_extras(rows: Table, extras: Extras, unit: LengthUnit, factor: float) -> None:
    if extras.reaction is not None:
        reaction = extras.reaction
        rows.add_row("reaction, force (N)", _numbers(reaction.force))
        rows.add_row(f"reaction, moment (N {unit})", _numbers([factor * number for number in reaction.moment]))
        rows.add_row("reaction, size (N)", f"{reaction.size:.6f}, at least {reaction.least_size:.6f}")
    for wrench in extras.wrenches or ():
        moment = _numbers([factor * number for number in wrench.moment])
        rows.add_row(f"contact {wrench.contact}, at ({unit})", _numbers([factor * number for number in wrench.point]))
        rows.add_row(f"contact {wrench.contact}, normal", f"{_numbers(wrench.normal)}, moment {moment} N {unit}")
    if extras.forces_range is not None:
        dimension = extras.forces_range.internal_dimension
        rows.add_row("internal forces", "of a patch" if dimension is None else f"{dimension} dimensions")
        for one in extras.forces_range.contacts:
            largest = "no limit" if math.isinf(one.normal_max) else f"{one.normal_max:.6f}"
            rows.add_row(f"contact {one.contact}, normal (N)", f"{one.normal_min:.6f} to {largest}")
    for mode in extras.modes or ():
        twist = ""
        if mode.angular is not None and mode.linear is not None and mode.margin is not None:
            angular = _numbers([number / factor for number in mode.angular])
            twist = f", turns {angular} and moves {_numbers(mode.linear)}, margin {mode.margin:.2g}"
        rows.add_row(f"mode, {mode.status}", f"{', '.join(mode.contacts)}{twist}")


def print_threads(threads: Sequence[StandardThread]) -> None:
    """Standard threads, a row each, with the limits of their diameters in their own unit."""
    rows = table(
        *(
            "designation",
            "unit",
            "bolt major",
            "bolt pitch",
            "bolt minor",
            "nut major",
            "nut pitch",
            "nut minor",
            "source",
        ),
        words_last=True,
    )
    for one in threads:
        diameters = [bound for part in (one.bolt, one.nut) for bound in (part.major, part.pitch, part.minor)]
        rows.add_row(one.designation, one.unit, *map(_limits, diameters), one.source)
    rows.print()


def _limits(diameter: Diameter) -> str:
    least, greatest = ("..." if bound is None else number_text(bound) for bound in (diameter.least, diameter.greatest))
    return f"{least} to {greatest}"


def print_profiles(pairs: Sequence[Pair], unit: LengthUnit | None) -> None:
    """Diameters, fillets and play of pairs, one a column; lengths in ``unit`` (None: each in its own)."""
    from threadstate.thread.catalogue import source_of
    from threadstate.thread.play import play_of

    rows = table("pair", *(one.designation for one in pairs))

    def add(name: str, lengths: Iterable[float | None]) -> None:
        """A length of each pair, in a row."""
        cells = []
        for one, value in zip(pairs, lengths, strict=True):
            shown = unit or one.unit
            cells.append(length(scale_length(value, conversion_factor(one.unit, shown)), shown))
        rows.add_row(name, *cells)

    rows.add_row("lengths in", *(unit or one.unit for one in pairs))
    add("thread pitch", [one.thread_pitch for one in pairs])
    for diameter in ("major", "pitch", "minor"):
        for part in Part:
            add(f"{part}, {diameter} diameter", [getattr(one.fit, f"{part}_{diameter}_diameter") for one in pairs])
    for where in ("crest", "root"):
        for part in Part:
            radii = [getattr(one.form, f"{part}_{where}_fillet") * one.thread_pitch for one in pairs]
            add(f"{part}, {where} fillet", radii)
    if any(one.chamfer for one in pairs):
        add(
            "bolt, end diameter of its chamfer",
            [None if one.chamfer is None else one.chamfer.end_diameter for one in pairs],
        )
    plays = [play_of(one) for one in pairs]
    add("radial play at the bolt's crest", [play.crest for play in plays])
    add("radial play at the bolt's root", [play.root for play in plays])
    add("axial play, either way", [play.axial for play in plays])
    rows.print()
    for one in pairs:
        print_line(f"{one.designation}: {source_of(one) or OWN_DIMENSIONS}")


def print_jamming(document: JammingDocument) -> None:
    """A jamming diagram: what it is, then a piece of its boundary a row."""
    from threadstate.statics.jamming_document import contacts_text, piece_text

    rows = table("", "")
    rows.add_row("roll, pitch, phase (deg)", _numbers([document["roll"], document["pitch"], document["phase"]]))
    rows.add_row("mu", number_text(document["mu"]))
    rows.add_row("axes, over the push", ", ".join(document["axes"]))
    rows.add_row("diagram", f"{document['kind']}{' (the solids overlap)' if document['penetrating'] else ''}")
    if document["wedged"]:
        rows.add_row("can wedge", contacts_text(document["wedged"]))
    if document["window"] is not None:
        rows.add_row("seen to", f"±{_numbers(document['window'][:1])}, ±{_numbers(document['window'][1:])}")
    for ray in document["rays"]:
        rows.add_row("without an end along", _numbers(ray))
    rows.add_row("gap", f"{document['gap']:.1e}")
    for piece in document["pieces"]:
        if not piece["window"]:
            start, end = (document["vertices"][piece[name]] for name in ("first", "last"))
            how = (
                ""
                if document["dimension"] != 2
                else f" {'straight' if piece['straight'] else 'curved'} to {_numbers(end)}"
            )
            rows.add_row(_numbers(start) + how, piece_text(document, piece))
    rows.print()


def _numbers(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.6g}" for value in values)


def _friction(mu: float | None) -> str:
    return "no friction does" if mu is None else f"{mu:.6f}"


def _effort(effort: float | None) -> str:
    if effort is None:
        return "not pressed on a contact"
    return "jams" if math.isinf(effort) else f"{effort:.6f} of push times radius"
