"""Undecided poses as rows."""

from __future__ import annotations

from threadstate.export.column import Column, degrees, words
from threadstate.state.model import UndecidedPose

UNDECIDED_COLUMNS: tuple[Column[UndecidedPose], ...] = (
    degrees("roll", "roll of the pose", lambda pose: pose.roll_deg),
    degrees("pitch", "pitch of the pose", lambda pose: pose.pitch_deg),
    degrees("phase", "phase of the pose", lambda pose: pose.phase_deg),
    words("reason", "why the library's method could not decide the pose", lambda pose: pose.reason),
)
