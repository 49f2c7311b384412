"""Standard threads."""

from __future__ import annotations

from threadstate.client.models.answer import Answer
from threadstate.units import LengthUnit

Bounds = tuple[float | None, float | None]
"""The least and the greatest; None where the standard sets no limit."""


class Limits(Answer):
    """The diameters of a bolt's or a nut's thread."""

    major: Bounds
    pitch: Bounds
    minor: Bounds


class StandardThread(Answer):
    """A standard thread with its tolerance classes; lengths in its own ``unit``.

    ``source`` is the standard, and on what its numbers rest.
    """

    designation: str
    form: str
    unit: LengthUnit
    thread_pitch: float
    bolt: Limits
    nut: Limits
    source: str


class StandardThreadList(Answer):
    """Standard threads, form by form, the smallest first."""

    threads: tuple[StandardThread, ...]
