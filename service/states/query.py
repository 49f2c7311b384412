"""What a client may ask of the states of a library."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.state.model import Flag, StateClass
from threadstate.state.quantities import QUANTITIES
from threadstate.thread.regions import Region


@dataclass(frozen=True)
class StateFilter:
    """Conditions that all hold for a state; None stands for any. Angles in degrees."""

    roll_deg: float | None = None
    pitch_deg: float | None = None
    phase_deg: float | None = None
    phase_min_deg: float | None = None
    phase_max_deg: float | None = None
    state_class: StateClass | None = None
    bolt_region: Region | None = None
    nut_region: Region | None = None
    flag: Flag | None = None


SORT_KEYS = ("roll", "pitch", "phase", "class", *(quantity.name for quantity in QUANTITIES if quantity.sortable))
"""What states can be sorted by; ties, and ``roll``, are in the order of roll, pitch and phase."""


@dataclass(frozen=True)
class Sort:
    """An order of states. Where a length or turn is absent the state counts as the smallest.

    ``descending`` is the exact reverse of ascending, ties included.
    """

    key: str = "roll"
    descending: bool = False

    @property
    def name(self) -> str:
        """The order as a client writes it."""
        return ("-" if self.descending else "") + self.key


SORTS = {sort.name: sort for key in SORT_KEYS for sort in (Sort(key), Sort(key, descending=True))}
"""All orders by their names."""


@dataclass(frozen=True)
class Place:
    """A state's place in an order: its value of the sort key (None where absent or not needed), and its ordinal."""

    value: float | str | None
    ordinal: int
