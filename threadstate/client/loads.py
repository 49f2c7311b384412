"""Loads as the arguments of a client's methods, checked before they are sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from threadstate.client.call import QueryValue
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.statics.load import DEFAULT_FRICTION, Load, checked_friction


class LoadToBear(TypedDict, total=False):
    """A load on the bolt, in the nut's frame, and the friction of the contacts; what is left out has its default."""

    force: Sequence[float]
    moment: Sequence[float]
    point: Sequence[float]
    mu: float


def load_query(
    mu: float | None,
    force: Sequence[float] | None,
    moment: Sequence[float] | None,
    point: Sequence[float] | None,
) -> dict[str, QueryValue]:
    """The query parameters of a load, as far as they are given.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite, a vector is not three finite numbers, or the load is zero.
    """
    given = {"force": force, "moment": moment, "point": point, "mu": mu}
    checked = checked_load({name: value for name, value in given.items() if value is not None})
    query: dict[str, QueryValue] = {"mu": mu}
    for name, value in checked.items():
        if isinstance(value, tuple):
            query[name] = ",".join(map(number_text, value))
    return query


def under_load_query(
    mu: float | None,
    force: Sequence[float] | None,
    moment: Sequence[float] | None,
    point: Sequence[float] | None,
) -> dict[str, QueryValue]:
    """The query parameters of a load, none of which is given without ``mu``.

    Raises:
        InvalidValueError: a load that is not valid, or one without ``mu``.
    """
    for name, value in (("force", force), ("moment", moment), ("point", point)):
        if mu is None and value is not None:
            raise InvalidValueError(name, value, "with mu, the coefficient of friction under that load")
    return {} if mu is None else load_query(mu, force, moment, point)


def checked_load(load: Mapping[str, Any], location: str = "") -> dict[str, tuple[float, ...] | float]:
    """What is given of a load, as doubles; ``location`` comes before its names in errors."""
    for name in load:
        if name not in LoadToBear.__annotations__:
            raise InvalidValueError(f"{location}{name}", load[name], "one of " + ", ".join(LoadToBear.__annotations__))
    vectors = {name: _doubles(f"{location}{name}", value) for name, value in load.items() if name != "mu"}
    mu = float(load.get("mu", DEFAULT_FRICTION))
    try:
        Load(**vectors)  # type: ignore[arg-type]
        checked_friction(mu)
    except InvalidValueError as error:
        raise InvalidValueError(location + error.name, error.value, error.valid) from None
    return {**vectors, "mu": mu}


def _doubles(name: str, values: Sequence[float]) -> tuple[float, ...]:
    try:
        return tuple(float(value) for value in values)
    except (TypeError, ValueError):
        raise InvalidValueError(name, values, "three finite numbers") from None
