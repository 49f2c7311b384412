"""The methods by which the states of a library are found."""

from __future__ import annotations

from enum import StrEnum


class Method(StrEnum):
    """How contact states are found."""

    EXACT = "exact"
    """By the closed form of edge curves and threads."""
    MESH = "mesh"
    """By the collision of triangle meshes: the paper's method."""
