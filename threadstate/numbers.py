"""Numbers as text: written so that they read back the same."""

from __future__ import annotations


def number_text(value: float) -> str:
    """The shortest decimal that reads back as the same double; a whole number has no point, and zero no sign."""
    # Not repr: that of NumPy's doubles, which are floats too, names their type.
    return float.__repr__(value + 0.0).removesuffix(".0")
