"""Requests for what loads do to states. Loads are checked before anything is sent."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypedDict

from threadstate.client.call import LATEST, Call, LibraryName, get, library_path, path_of, post
from threadstate.client.models.statics import Statics, StaticsAnswer
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.statics.load import DEFAULT_FRICTION, Load, checked_friction

MOST_COMBINATIONS = 1000
"""Of poses with loads in a request."""


class LoadToBear(TypedDict, total=False):
    """A load on the bolt, in the nut's frame, and the friction of the contacts; what is left out has its default."""

    force: Sequence[float]
    moment: Sequence[float]
    point: Sequence[float]
    mu: float


def statics(
    roll: float,
    pitch: float,
    phase: float,
    *,
    mu: float = DEFAULT_FRICTION,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[Statics]:
    """What a load does to the state of a pose of the library's grid, where all contacts have the friction ``mu``.

    The load is a ``force`` on the bolt in N, and a ``moment`` in N times the unit of length about ``point``, in the
    nut's frame; by default a push of 1 N along -z, and the bolt's origin. Lengths of the load and of the answer are in
    ``unit``, else in the library's own.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite, a vector is not three finite numbers, or the load is zero.
    """
    given = {"force": force, "moment": moment, "point": point}
    checked = _checked({**{name: value for name, value in given.items() if value is not None}, "mu": mu})
    query = {name: ",".join(map(number_text, value)) for name, value in checked.items() if isinstance(value, tuple)}
    return get(library_path(library, "states", roll, pitch, phase, "statics"), Statics, **query, mu=mu, unit=unit)


def solve_statics(
    poses: Iterable[tuple[float, float, float]],
    loads: Iterable[LoadToBear] = ({},),
    *,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[StaticsAnswer]:
    """The statics of poses (roll, pitch, phase), on a grid or not, each under every load: 1 to 1000 of them.

    A load has ``force``, ``moment``, ``point`` and ``mu`` as for ``statics``, each with its default. Of a known thread,
    or with the pair and the tolerances of ``library``.

    Raises:
        InvalidValueError: there are none or too many, or a load is not valid.
    """
    named = [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses]
    checked = [_checked(load, f"loads {number} ") for number, load in enumerate(loads)]
    count = len(named) * len(checked)
    if not 1 <= count <= MOST_COMBINATIONS:
        raise InvalidValueError("poses times loads", count, f"1 to {MOST_COMBINATIONS}")
    body = {"designation": designation, "library": library, "poses": named, "loads": checked}
    # Nothing is stored: repeatable.
    return post(path_of("v1", "statics"), StaticsAnswer, body, repeatable=True, unit=unit)


def _checked(load: Mapping[str, Any], location: str = "") -> dict[str, tuple[float, ...] | float]:
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
