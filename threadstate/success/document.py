"""Success maps as JSON objects: one an orientation, as files have them, and a whole map; their content hash."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence
from typing import Any

from typing_extensions import TypedDict

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag
from threadstate.success.model import Cell, CriticalFriction, OrientationMap, PhaseBoundary


class CellDocument(TypedDict):
    """A path of a map; torque in N times the unit, angles in degrees. Null where it has none."""

    phase: float
    mu: float
    outcome: AssemblyOutcome
    flags: list[SettledFlag]
    bounded: bool
    torque: float | None
    tilt: float | None
    shift: float | None
    end: float | None


class PhaseBoundaryDocument(TypedDict):
    """A boundary of outcome along the starting phase."""

    mu: float
    phase_from: float
    phase_to: float
    outcome_before: AssemblyOutcome
    outcome_after: AssemblyOutcome


class CriticalFrictionDocument(TypedDict):
    """The interval of the critical friction, and the phase and the outcome that end it."""

    last: float | None
    first: float | None
    phase: float | None
    outcome: AssemblyOutcome | None
    reenters: bool


class OrientationDocument(TypedDict):
    """The map of an orientation."""

    index: int
    roll: float
    pitch: float
    cells: list[CellDocument]
    boundaries: list[PhaseBoundaryDocument]
    critical: CriticalFrictionDocument


def orientation_document(found: OrientationMap) -> OrientationDocument:
    """The document of an orientation's map, in the pair's unit."""
    critical = found.critical
    return {
        "index": found.index,
        "roll": found.roll_deg + 0.0,
        "pitch": found.pitch_deg + 0.0,
        "cells": [cell_document(cell) for cell in found.cells],
        "boundaries": [
            {
                "mu": boundary.mu + 0.0,
                "phase_from": boundary.from_deg + 0.0,
                "phase_to": boundary.to_deg + 0.0,
                "outcome_before": boundary.outcome_before,
                "outcome_after": boundary.outcome_after,
            }
            for boundary in found.boundaries
        ],
        "critical": {
            "last": _plain(critical.last),
            "first": _plain(critical.first),
            "phase": _plain(critical.phase_deg),
            "outcome": critical.outcome,
            "reenters": critical.reenters,
        },
    }


def cell_document(cell: Cell) -> CellDocument:
    """The document of a path of a map, in the pair's unit."""
    return {
        "phase": cell.phase_deg + 0.0,
        "mu": cell.mu + 0.0,
        "outcome": cell.outcome,
        "flags": list(cell.flags),
        "bounded": cell.is_bounded,
        "torque": _plain(cell.torque),
        "tilt": _plain(cell.tilt_deg),
        "shift": _plain(cell.shift),
        "end": _plain(cell.end_deg),
    }


def orientation_from_document(document: OrientationDocument) -> OrientationMap:
    """The map of its document.

    Raises:
        KeyError, TypeError, ValueError: it is not a document of such a map.
    """
    critical = document["critical"]
    return OrientationMap(
        document["index"],
        document["roll"],
        document["pitch"],
        tuple(
            Cell(
                cell["phase"],
                cell["mu"],
                AssemblyOutcome(cell["outcome"]),
                tuple(SettledFlag(flag) for flag in cell["flags"]),
                cell["bounded"],
                cell["torque"],
                cell["tilt"],
                cell["shift"],
                cell["end"],
            )
            for cell in document["cells"]
        ),
        tuple(
            PhaseBoundary(
                boundary["mu"],
                boundary["phase_from"],
                boundary["phase_to"],
                AssemblyOutcome(boundary["outcome_before"]),
                AssemblyOutcome(boundary["outcome_after"]),
            )
            for boundary in document["boundaries"]
        ),
        CriticalFriction(
            critical["last"],
            critical["first"],
            critical["phase"],
            None if critical["outcome"] is None else AssemblyOutcome(critical["outcome"]),
            critical["reenters"],
        ),
    )


def orientation_sha256(found: OrientationMap) -> str:
    """SHA-256, in hexadecimal, of an orientation's document, in which every number is its shortest decimal."""
    return hashlib.sha256(document_text(orientation_document(found)).encode()).hexdigest()


def map_sha256(orientations: Sequence[OrientationMap]) -> str:
    """SHA-256, in hexadecimal, of a whole map: of its orientations' hashes in the order of the grid."""
    ordered = sorted(orientations, key=lambda one: one.index)
    return map_sha256_of(map(orientation_sha256, ordered))


def map_sha256_of(orientation_hashes: Iterable[str]) -> str:
    """The hash of a whole map from its orientations' hashes, in the order of the grid."""
    return hashlib.sha256("\n".join(orientation_hashes).encode()).hexdigest()


def document_text(document: Any) -> str:
    """A document as one line of compact JSON.

    Raises:
        ValueError: a number is not finite.
    """
    return json.dumps(document, separators=(",", ":"), allow_nan=False)


def _plain(value: float | None) -> float | None:
    return None if value is None else value + 0.0
