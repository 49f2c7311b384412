"""The solver methods by which a library is computed."""

from __future__ import annotations

from enum import StrEnum


class SolverMethod(StrEnum):
    """How contact states are computed."""

    EXACT = "exact"
    """By the closed form of edge curves and threads."""
    MESH = "mesh"
    """By the collision of triangle meshes: the paper's procedure."""
