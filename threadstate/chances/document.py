"""Records as JSON objects, one a sample, as files have them, and their content hash."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

from typing_extensions import TypedDict

from threadstate.chances.model import Formation, Leaving, LegName, Reading, Record, Visit
from threadstate.chances.sampling import Approach
from threadstate.device.assembly_model import AssemblyOutcome, Held
from threadstate.device.model import SettledFlag
from threadstate.state.model import FeaturePair, Vector


class VisitDocument(TypedDict):
    """A visit; ``phases``, ``torques`` and ``forces`` are lists of equal length."""

    held: Held
    features: list[FeaturePair]
    leg: LegName
    phase_from: float
    phase_to: float
    left: Leaving
    phases: list[float]
    torques: list[float]
    forces: list[Vector]


class RecordDocument(TypedDict):
    """A sampled path; torques in N times the pair's unit, angles in degrees. Null where it has none."""

    index: int
    roll: float
    pitch: float
    phase: float
    mu: float
    outcome: AssemblyOutcome
    flags: list[SettledFlag]
    bounded: bool
    turned: float | None
    assembled: float | None
    torque: float | None
    tilt: float | None
    shift: float | None
    visits: list[VisitDocument]


def record_document(record: Record) -> RecordDocument:
    """The document of a sample."""
    one = record.approach
    return {
        "index": one.index,
        "roll": one.roll_deg,
        "pitch": one.pitch_deg,
        "phase": one.phase_deg,
        "mu": one.mu,
        "outcome": record.outcome,
        "flags": list(record.flags),
        "bounded": record.is_bounded,
        "turned": record.turned_deg,
        "assembled": record.assembled_deg,
        "torque": record.torque,
        "tilt": record.tilt_deg,
        "shift": record.shift,
        "visits": [_visit_document(visit) for visit in record.visits],
    }


def record_from_document(document: RecordDocument) -> Record:
    """The record of its document.

    Raises:
        KeyError, TypeError, ValueError: it is not a document of a sample.
    """
    return Record(
        Approach(document["index"], document["roll"], document["pitch"], document["phase"], document["mu"]),
        AssemblyOutcome(document["outcome"]),
        tuple(SettledFlag(flag) for flag in document["flags"]),
        document["bounded"],
        document["turned"],
        document["assembled"],
        document["torque"],
        document["tilt"],
        document["shift"],
        tuple(_visit(visit) for visit in document["visits"]),
    )


def record_sha256(record: Record) -> str:
    """SHA-256, in hexadecimal, of a sample's document, in which every number is its shortest decimal."""
    text = json.dumps(record_document(record), separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def records_sha256(records: Sequence[Record]) -> str:
    """SHA-256, in hexadecimal, of several samples: of their own hashes, one a line, by their numbers."""
    ordered = sorted(records, key=lambda one: one.approach.index)
    return hashlib.sha256("\n".join(map(record_sha256, ordered)).encode()).hexdigest()


def _visit_document(visit: Visit) -> VisitDocument:
    return {
        "held": visit.formation.held,
        "features": list(visit.formation.features),
        "leg": visit.leg,
        "phase_from": visit.from_deg + 0.0,
        "phase_to": visit.to_deg + 0.0,
        "left": visit.left,
        "phases": [reading.phase_deg for reading in visit.readings],
        "torques": [reading.torque for reading in visit.readings],
        "forces": [reading.force for reading in visit.readings],
    }


def _visit(document: VisitDocument) -> Visit:
    columns = (document["phases"], document["torques"], document["forces"])
    readings = []
    for phase_deg, torque, (fx, fy, fz) in zip(*columns, strict=True):
        readings.append(Reading(phase_deg, torque, (fx, fy, fz)))
    if not readings:
        raise ValueError("a visit without readings")
    return Visit(
        Formation(Held(document["held"]), tuple(FeaturePair(pair) for pair in document["features"])),
        LegName(document["leg"]),
        document["phase_from"],
        document["phase_to"],
        Leaving(document["left"]),
        tuple(readings),
    )
