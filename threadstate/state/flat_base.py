"""What is there for bolts that are cut flat alone refuses one with a chamfer (decision 28)."""

from __future__ import annotations

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.thread.pair import Pair


def require_flat_base(pair: Pair, asked: str) -> None:
    """Check that the pair's bolt is cut flat, as what is ``asked`` needs it.

    Raises:
        InvalidValueError: the bolt has a chamfer.
    """
    if pair.chamfer is not None:
        given = f"end diameter {number_text(pair.chamfer.end_diameter)} {pair.unit}"
        valid = f"none for {asked}, whose bolts are cut flat; `threadstate solve --method mesh` takes a chamfer"
        raise InvalidValueError("chamfer", given, valid)
