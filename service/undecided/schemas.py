"""The shape of undecided poses in an answer."""

from __future__ import annotations

from pydantic import BaseModel, Field

from threadstate.state.model import UndecidedPose


class UndecidedPhase(BaseModel):
    """An undecided pose of an orientation."""

    phase: float
    reason: str = Field(description="why the method could not decide the pose")


class UndecidedDocument(UndecidedPhase):
    """An undecided pose, in degrees."""

    roll: float
    pitch: float


class UndecidedPage(BaseModel):
    """Undecided poses in the order of roll, pitch and phase."""

    library: int = Field(description="number of the library")
    undecided: list[UndecidedDocument]
    next: str | None = Field(description="address of the next page; null on the last")


def undecided_document(pose: UndecidedPose) -> UndecidedDocument:
    """The document of an undecided pose."""
    return UndecidedDocument(roll=pose.roll_deg, pitch=pose.pitch_deg, phase=pose.phase_deg, reason=pose.reason)
