"""Numbers as text: written so that they read back the same, and read by one syntax wherever they come from."""

from __future__ import annotations

import math
import re

from threadstate.errors import InvalidValueError

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_INTEGER = re.compile(r"[+-]?[0-9]{1,18}")


def number_text(value: float) -> str:
    """The shortest decimal that reads back as the same double; a whole number has no point, and zero no sign."""
    # Not repr: that of NumPy's doubles, which are floats too, names their type.
    return float.__repr__(value + 0.0).removesuffix(".0")


def number(text: str) -> float:
    """The double of a decimal number: ASCII digits, with a sign, a point and an exponent where there are any.

    Raises:
        ValueError: it is anything else, as what Python would read too (``1_0``, ``nan``, `` 1``), or too large.
    """
    if not _NUMBER.fullmatch(text) or math.isinf(value := float(text)):
        raise ValueError(f"{text!r} is not a decimal number such as -1.25")
    return value


def integer(text: str) -> int:
    """The whole number of ASCII digits, with a sign where there is one.

    Raises:
        ValueError: it is anything else, or has more than 18 digits.
    """
    if not _INTEGER.fullmatch(text):
        raise ValueError(f"{text!r} is not a whole number such as 12")
    return int(text)


def three_numbers(name: str, text: str) -> tuple[float, float, float]:
    """The numbers of a text that has three, separated by commas; ``name`` is what they are.

    Raises:
        InvalidValueError: the text is anything else.
    """
    try:
        x, y, z = (number(part.strip()) for part in text.split(","))
    except ValueError:
        raise InvalidValueError(name, text, "three numbers, separated by commas") from None
    return x, y, z
