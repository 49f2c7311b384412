"""Records in another unit of length."""

from __future__ import annotations

from dataclasses import replace

from threadstate.chances.model import Record, Visit
from threadstate.units import scale_length


def scaled_record(record: Record, factor: float) -> Record:
    """A record with its shift, and its torques in N times a length, multiplied by ``factor``."""
    if factor == 1.0:
        return record
    return replace(
        record,
        torque=scale_length(record.torque, factor),
        shift=scale_length(record.shift, factor),
        visits=tuple(_scaled_visit(visit, factor) for visit in record.visits),
    )


def _scaled_visit(visit: Visit, factor: float) -> Visit:
    readings = tuple(replace(reading, torque=reading.torque * factor) for reading in visit.readings)
    return replace(visit, readings=readings)
