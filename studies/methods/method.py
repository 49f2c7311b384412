"""A method under test: cases in, for each a contact state or a refusal out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from studies.methods.case import Case
from threadstate.state.model import ContactState
from threadstate.thread.pair import Pair


@dataclass(frozen=True, slots=True)
class Refusal:
    """A method says that it cannot answer, and why."""

    reason: str


Answer = ContactState | Refusal


class Method(Protocol):
    """Anything that answers cases; it must be picklable, and the same case must have the same answer."""

    @property
    def name(self) -> str:
        """What it is called on the page."""

    def declared_error(self, pair: Pair) -> float:
        """How far its contacts may be off the surfaces and its heights off the true ones, in the pair's unit."""

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases."""
