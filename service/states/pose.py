"""The address of a state by its pose."""

from __future__ import annotations

from threadstate.numbers import number_text

STATE_ROUTE = "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"


def content_location(library_id: int, roll_deg: float, pitch_deg: float, phase_deg: float) -> str:
    """The address of a state in this very library, angles in degrees."""
    return f"/v1/libraries/{library_id}/states/{'/'.join(map(number_text, (roll_deg, pitch_deg, phase_deg)))}"
