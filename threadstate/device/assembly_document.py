"""Paths as the JSON objects that the command line prints."""

from __future__ import annotations

from typing_extensions import TypedDict

from threadstate.device.assembly_model import (
    AssemblyEnergy,
    AssemblyMargins,
    AssemblyOutcome,
    AssemblyPath,
    AssemblyPoint,
    AssemblyTravel,
    ContactMotion,
    Held,
    PathEvent,
    PathEventKind,
)
from threadstate.device.document import (
    DeviationDocument,
    SettledContactDocument,
    SettledDocument,
    contact_document,
    scaled,
    settled_document,
    vector_document,
)
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathProgress
from threadstate.state.document import PoseDocument, VectorDocument
from threadstate.state.model import FeaturePair
from threadstate.units import LengthUnit


class AssemblyEventDocument(TypedDict):
    """An event of a path, between two phases in degrees; null where it has none of a kind."""

    kind: PathEventKind
    phase: float
    from_phase: float
    features_before: FeaturePair | None
    features: FeaturePair | None
    point: VectorDocument | None
    drop: float | None
    way: float | None
    energy: float | None


class AssemblyPathDocument(TypedDict):
    """The points of a path, a list of each kind of number, all equally long."""

    phase: list[float]
    held: list[Held]
    pose: list[PoseDocument]
    deviation: list[DeviationDocument]
    contacts: list[list[SettledContactDocument]]
    motions: list[list[ContactMotion]]
    torque: list[float]
    elastic_energy: list[float]
    potential: list[float]


class AssemblyEnergyDocument(TypedDict):
    """Where the energy of a path went, in N times the unit."""

    work: float
    push: float
    elastic: float
    friction: float
    falls: float
    balance: float


class AssemblyMarginsDocument(TypedDict):
    """How far an outcome is from another one; null where a rule was not asked."""

    lead: float | None
    play: float | None
    tilt: float | None
    torque: float
    offset: float
    snap: float | None


class AssemblyTravelDocument(TypedDict):
    """What a path asks of the device: torque in N times the unit, tilt in degrees, shift."""

    torque: float
    tilt: float
    shift: float


class AssemblyDocument(TypedDict):
    """A path; angles in degrees, lengths in the unit of the answer, energies in N times that unit."""

    roll: float
    pitch: float
    phase: float
    unit: LengthUnit
    strategy: Strategy
    mu: float
    outcome: AssemblyOutcome
    flags: list[SettledFlag]
    start: SettledDocument
    events: list[AssemblyEventDocument]
    path: AssemblyPathDocument
    energy: AssemblyEnergyDocument | None
    margins: AssemblyMarginsDocument | None
    travel: AssemblyTravelDocument | None


class AssemblyProgressDocument(TypedDict):
    """How far a path is: the number of its turn (0 while the bolt settles), the points of that one and the phase of the
    last in degrees, and events that are new.
    """

    leg: int
    points: int
    phase: float | None
    events: list[AssemblyEventDocument]


def progress_document(progress: PathProgress, sent: int, factor: float = 1.0) -> AssemblyProgressDocument:
    """The document of how far a path is, with the events after the first ``sent`` ones."""
    return {
        "leg": progress.leg,
        "points": progress.points,
        "phase": progress.phase_deg,
        "events": [path_event_document(event, factor) for event in progress.events[sent:]],
    }


def assembly_document(path: AssemblyPath, unit: LengthUnit, factor: float = 1.0) -> AssemblyDocument:
    """The document of a path, its lengths multiplied by ``factor`` to be in ``unit``."""
    start = settled_document(path.start, unit, factor)
    return {
        "roll": start["roll"],
        "pitch": start["pitch"],
        "phase": start["phase"],
        "unit": unit,
        "strategy": path.strategy,
        "mu": path.mu,
        "outcome": path.outcome,
        "flags": list(path.flags),
        "start": start,
        "events": [path_event_document(event, factor) for event in path.events],
        "path": _points(path.points, factor),
        "energy": None if path.energy is None else _energy(path.energy, factor),
        "margins": None if path.margins is None else _margins(path.margins, factor),
        "travel": None if path.travel is None else _travel(path.travel, factor),
    }


def path_event_document(event: PathEvent, factor: float = 1.0) -> AssemblyEventDocument:
    """The document of an event, its lengths multiplied by ``factor``."""
    return {
        "kind": event.kind,
        "phase": event.phase_deg + 0.0,
        "from_phase": event.from_deg + 0.0,
        "features_before": event.features_before,
        "features": event.features,
        "point": None if event.point is None else vector_document(event.point, factor),
        "drop": scaled(event.drop, factor),
        "way": scaled(event.way, factor),
        "energy": scaled(event.energy, factor),
    }


def _points(points: tuple[AssemblyPoint, ...], factor: float) -> AssemblyPathDocument:
    return {
        "phase": [point.phase_deg + 0.0 for point in points],
        "held": [point.held for point in points],
        "pose": [
            {
                "rotation": [vector_document(row) for row in point.pose.rotation],
                "translation": vector_document(point.pose.translation, factor),
            }
            for point in points
        ],
        "deviation": [
            {"shift": vector_document(point.shift, factor), "rotation": vector_document(point.rotation_deg)}
            for point in points
        ],
        "contacts": [[contact_document(contact, factor) for contact in point.contacts] for point in points],
        "motions": [list(point.motions) for point in points],
        "torque": [point.torque * factor + 0.0 for point in points],
        "elastic_energy": [point.elastic_energy * factor + 0.0 for point in points],
        "potential": [point.potential * factor + 0.0 for point in points],
    }


def _energy(energy: AssemblyEnergy, factor: float) -> AssemblyEnergyDocument:
    return {
        "work": energy.work * factor + 0.0,
        "push": energy.push * factor + 0.0,
        "elastic": energy.elastic * factor + 0.0,
        "friction": energy.friction * factor + 0.0,
        "falls": energy.falls * factor + 0.0,
        "balance": energy.balance * factor + 0.0,
    }


def _margins(margins: AssemblyMargins, factor: float) -> AssemblyMarginsDocument:
    return {
        "lead": margins.lead,
        "play": scaled(margins.play, factor),
        "tilt": margins.tilt_deg,
        "torque": margins.torque,
        "offset": margins.offset * factor,
        "snap": scaled(margins.snap, factor),
    }


def _travel(travel: AssemblyTravel, factor: float) -> AssemblyTravelDocument:
    return {"torque": travel.torque * factor, "tilt": travel.tilt_deg, "shift": travel.shift * factor}
