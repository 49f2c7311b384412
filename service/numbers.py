"""Numbers as parameters of a request: those of :mod:`threadstate.numbers`, not all that Python would read."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from pydantic import BeforeValidator
from pydantic_core import PydanticKnownError

from threadstate.numbers import integer, number


def _written(read: Callable[[str], float], error_type: Literal["float_parsing", "int_parsing"]) -> BeforeValidator:
    """Refuses any other text in pydantic's words; whether a body may hold texts of numbers is for its model to say."""

    def check(value: object) -> object:
        if isinstance(value, str):
            try:
                read(value)
            except ValueError:
                raise PydanticKnownError(error_type) from None
        return value

    return BeforeValidator(check)


# To be the last in an annotation: of limits that come after it the description of the interface says nothing.
NUMBER_TEXT = _written(number, "float_parsing")
"""Of a text that is to be read as a number."""
INTEGER_TEXT = _written(integer, "int_parsing")
"""Of a text that is to be read as a whole number."""
