"""The curves of a path over the phase of the hand, from its document."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from threadstate.device.assembly_document import AssemblyDocument, AssemblyEventDocument, AssemblyPathDocument
from threadstate.device.assembly_model import PathEventKind
from threadstate.report.words import NEWTON

TURNING_DEG = 1e-6
"""The hand turns where its phase changes by more than that."""


@dataclass(frozen=True, slots=True)
class Series:
    """A number at each point of a path, and its name where a chart has several."""

    name: str
    values: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Chart:
    """What is drawn over the phase in one picture."""

    name: str
    title: str
    unit: str
    series: tuple[Series, ...]


@dataclass(frozen=True, slots=True)
class Course:
    """How the hand turns along a path: of each point the phase, how far the hand has turned since the start, and its
    leg, a turn of one sense, counted from 0. All in degrees.
    """

    phases_deg: tuple[float, ...]
    turned_deg: tuple[float, ...]
    legs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Mark:
    """An event that a chart shows, at how far the hand has turned (deg)."""

    kind: PathEventKind
    turned_deg: float


SHOWN = (PathEventKind.FALL, PathEventKind.SNAP)


def course_of(path: AssemblyPathDocument) -> Course:
    """How the hand turns along a path with points."""
    phases = path["phase"]
    steps = [after - before for before, after in pairwise(phases)]
    legs, sense = [0], 0.0
    for step in steps:
        turns = abs(step) > TURNING_DEG
        reverses = turns and sense * step < 0.0
        sense = step if turns else sense
        legs.append(legs[-1] + reverses)
    return Course(tuple(phases), tuple(accumulate(map(abs, steps), initial=0.0)), tuple(legs))


def points_of_events(path: AssemblyPathDocument, events: Sequence[AssemblyEventDocument]) -> list[int]:
    """The number of the point at which each event has happened; both are in the order in which the hand turns."""
    phases, at, found = path["phase"], 0, []
    for event in events:
        width = abs(event["from_phase"] - event["phase"]) + TURNING_DEG
        for k in range(max(at, 1), len(phases)):
            if phases[k] == event["phase"] and abs(phases[k - 1] - event["phase"]) <= width:
                at = k
                break
        found.append(at)
    return found


def marks_of(document: AssemblyDocument, course: Course) -> tuple[Mark, ...]:
    """The falls and the snap of a path."""
    events = document["events"]
    places = points_of_events(document["path"], events)
    return tuple(
        Mark(event["kind"], course.turned_deg[at])
        for event, at in zip(events, places, strict=True)
        if event["kind"] in SHOWN
    )


def charts_of(document: AssemblyDocument) -> tuple[Chart, ...]:
    """The charts of a path with points: height, torque, contact forces, tilt, shift and energies."""
    path, unit = document["path"], document["unit"].value
    forces = [[math.hypot(*contact["force"]) for contact in contacts] for contacts in path["contacts"]]
    tilts = [_tilt_deg(pose["rotation"][2]) for pose in path["pose"]]
    device_tilts = [math.hypot(*deviation["rotation"]) for deviation in path["deviation"]]
    shifts = [math.hypot(*deviation["shift"][:2]) for deviation in path["deviation"]]
    return (
        _chart("height", "Height of the bolt", unit, ("origin", [pose["translation"][2] for pose in path["pose"]])),
        _chart("torque", "Torque of the hand", f"{NEWTON}{unit}", ("torque", path["torque"])),
        _chart(
            *("forces", "Contact forces", "N"),
            ("largest", [max(sizes, default=0.0) for sizes in forces]),
            ("sum", [sum(sizes) for sizes in forces]),
        ),
        _chart("tilt", "Tilt", "deg", ("bolt against nut", tilts), ("of the device", device_tilts)),
        _chart("shift", "Shift of the compliance centre", unit, ("shift", shifts)),
        _chart("energy", "Energy since the start", f"{NEWTON}{unit}", *_energies(document)),
    )


def _chart(name: str, title: str, unit: str, *series: tuple[str, Sequence[float]]) -> Chart:
    return Chart(name, title, unit, tuple(Series(called, tuple(values)) for called, values in series))


def _tilt_deg(row: Sequence[float]) -> float:
    return math.degrees(math.atan2(math.hypot(row[0], row[1]), row[2]))


def _energies(document: AssemblyDocument) -> Iterator[tuple[str, Sequence[float]]]:
    """Works and losses since the start; what they leave is the loss by friction and the error of the sum."""
    path, events = document["path"], document["events"]
    phases, torques, elastic = path["phase"], path["torque"], path["elastic_energy"]
    steps = [
        0.5 * (torques[k] + torques[k - 1]) * math.radians(phases[k] - phases[k - 1]) for k in range(1, len(phases))
    ]
    work = list(accumulate(steps, initial=0.0))
    heights = [potential - part for potential, part in zip(path["potential"], elastic, strict=True)]
    push = [heights[0] - height for height in heights]
    stored = [part - elastic[0] for part in elastic]
    lost = [0.0] * len(phases)
    for event, at in zip(events, points_of_events(path, events), strict=True):
        lost[at] += event["energy"] or 0.0
    falls = list(accumulate(lost))
    rest = [work[k] + push[k] - stored[k] - falls[k] for k in range(len(phases))]
    yield "elastic", stored
    yield "work of the hand", work
    yield "work of the push", push
    yield "lost in falls", falls
    yield ("lost by friction" if document["mu"] else "error of the sum"), rest
