"""How much of the two parts is modelled."""

from __future__ import annotations

from enum import StrEnum


class Scene(StrEnum):
    """How much of bolt and nut is modelled, from the most to the least."""

    FULL = "full"
    """Both solids, closed."""
    BAND = "band"
    """What can be reached within 10 deg of tilt and 45 deg of turn: threads and cut ends, without what is behind."""
    EDGES = "edges"
    """That, with fine triangles along the two edge curves alone."""
    CURVES = "curves"
    """No triangles: points of the two edge curves, against the closed form of the other part."""
