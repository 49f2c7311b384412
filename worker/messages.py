"""What a computing process tells its parent, besides the chunks themselves."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Ready:
    """The kernels are loaded."""


@dataclass(frozen=True, slots=True)
class Failure:
    """The process cannot go on."""

    reason: str
