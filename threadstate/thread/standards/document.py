"""Standard threads as the JSON object of the command line and the service."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.thread.standards.designation import StandardThread
from threadstate.thread.standards.limits import Diameter, Limits
from threadstate.units import LengthUnit

BoundsDocument = Annotated[
    list[float | None],
    Field(min_length=2, max_length=2, description="least and greatest; null where the standard sets no limit"),
]


SourceDocument = Annotated[
    str | None,
    Field(
        description="on what the pair's dimensions rest: its standard, and how far that was checked; null of a pair of "
        "one's own"
    ),
]


class LimitsDocument(TypedDict):
    """The diameters of a bolt's or a nut's thread."""

    major: BoundsDocument
    pitch: BoundsDocument
    minor: BoundsDocument


class StandardThreadDocument(TypedDict):
    """A standard thread with its tolerance classes."""

    designation: str
    form: str
    unit: LengthUnit
    thread_pitch: float
    bolt: LimitsDocument
    nut: LimitsDocument
    source: Annotated[str, Field(description="the standard, and on what its numbers rest here")]


class StandardThreadList(TypedDict):
    """Standard threads, form by form, the smallest first."""

    threads: list[StandardThreadDocument]


def standard_thread_list(threads: Iterable[StandardThread]) -> StandardThreadList:
    """The threads as an object."""
    return StandardThreadList(threads=[standard_thread_document(one) for one in threads])


def standard_thread_document(thread: StandardThread) -> StandardThreadDocument:
    """The thread as an object."""
    return StandardThreadDocument(
        designation=thread.designation,
        form=thread.form,
        unit=thread.unit,
        thread_pitch=thread.thread_pitch,
        bolt=_limits(thread.bolt),
        nut=_limits(thread.nut),
        source=thread.source,
    )


def _limits(limits: Limits) -> LimitsDocument:
    return LimitsDocument(major=_bounds(limits.major), pitch=_bounds(limits.pitch), minor=_bounds(limits.minor))


def _bounds(diameter: Diameter) -> BoundsDocument:
    return [diameter.least, diameter.greatest]
