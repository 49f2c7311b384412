"""Requests for what loads do to states. Loads are checked before anything is sent."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from threadstate.client.call import (
    LATEST,
    SVG,
    Call,
    LibraryName,
    QueryValue,
    get,
    get_content,
    joined,
    library_path,
    path_of,
    post,
)
from threadstate.client.loads import LoadToBear, checked_load, load_query
from threadstate.client.models.statics import ComputedHeld, ComputedJamming, HeldAnswer, Jamming, Statics, StaticsAnswer
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.statics.load import DEFAULT_FRICTION, checked_friction

MOST_COMBINATIONS = 1000
"""Of poses with loads in a request."""


def statics(
    roll: float,
    pitch: float,
    phase: float,
    *,
    mu: float = DEFAULT_FRICTION,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    include: Iterable[str] | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[Statics]:
    """What a load does to the state of a pose of the library's grid, where all contacts have the friction ``mu``.

    The load is a ``force`` on the bolt in N, and a ``moment`` in N times the unit of length about ``point``, in the
    nut's frame; by default a push of 1 N along -z, and the bolt's origin. Lengths of the load and of the answer are in
    ``unit``, else in the library's own. ``include`` names what is added: reaction, forces_range, modes,
    wrenches.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite, a vector is not three finite numbers, or the load is zero.
    """
    query = load_query(mu, force, moment, point)
    path = library_path(library, "states", roll, pitch, phase, "statics")
    return get(path, Statics, **query, include=joined(include), unit=unit)


def jamming(
    roll: float,
    pitch: float,
    phase: float,
    *,
    mu: float = DEFAULT_FRICTION,
    axes: Iterable[str] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    contacts: Iterable[int] | None = None,
    window: Sequence[float] | None = None,
    tolerance: float | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[Jamming]:
    """Which loads beside a push the contacts of a grid's state can balance: a diagram in the plane of two ``axes``.

    Axes are two of fx, fy, mx, my, mz. ``contacts`` are those that are taken, from 1; ``window`` has the half widths of
    what is seen of an unbounded diagram; ``tolerance`` is the gap that is aimed at, over the diagram's size. The load
    is that of ``statics``.

    Raises:
        InvalidValueError: as ``statics``.
    """
    query = load_query(mu, force, moment, point) | _shape(axes, contacts, window, tolerance)
    return get(library_path(library, "states", roll, pitch, phase, "jamming"), Jamming, **query, unit=unit)


def computed_jamming(
    roll: float,
    pitch: float,
    phase: float,
    *,
    mu: float = DEFAULT_FRICTION,
    axes: Iterable[str] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    contacts: Iterable[int] | None = None,
    window: Sequence[float] | None = None,
    tolerance: float | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[ComputedJamming]:
    """As ``jamming``, of any pose, computed on request, of a known thread or of a library's pair.

    Raises:
        InvalidValueError: as ``statics``.
    """
    query = load_query(mu, force, moment, point) | _shape(axes, contacts, window, tolerance)
    path = path_of("v1", "states", roll, pitch, phase, "jamming")
    return get(path, ComputedJamming, **query, designation=designation, library=library, unit=unit)


def jamming_svg(
    roll: float,
    pitch: float,
    phase: float,
    *,
    mu: float = DEFAULT_FRICTION,
    axes: Iterable[str] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    contacts: Iterable[int] | None = None,
    window: Sequence[float] | None = None,
    tolerance: float | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[bytes]:
    """The picture of a jamming diagram, as SVG; see ``jamming``.

    Raises:
        InvalidValueError: as ``statics``.
    """
    query = load_query(mu, force, moment, point) | _shape(axes, contacts, window, tolerance)
    path = library_path(library, "states", roll, pitch, phase, "jamming")
    return get_content(path, SVG, **query, format="svg", unit=unit)


def _shape(
    axes: Iterable[str] | None,
    contacts: Iterable[int] | None,
    window: Sequence[float] | None,
    tolerance: float | None,
) -> dict[str, QueryValue]:
    widths = None if window is None else ",".join(map(number_text, window))
    return {
        "axes": joined(axes),
        "contacts": joined(None if contacts is None else map(str, contacts)),
        "window": widths,
        "tolerance": tolerance,
    }


def held(
    roll: float,
    pitch: float,
    *,
    mu: float | Iterable[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[HeldAnswer]:
    """At which phases of an orientation the contacts can hold a load or wedge, at each friction ``mu``.

    The load is that of ``statics``.

    Raises:
        InvalidValueError: as ``statics``.
    """
    query = _held_query(mu, force, moment, point)
    return get(library_path(library, "histories", roll, pitch, "held"), HeldAnswer, **query, unit=unit)


def computed_held(
    roll: float,
    pitch: float,
    *,
    mu: float | Iterable[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[ComputedHeld]:
    """As ``held``, of any orientation, computed on request (about a second), of a known thread or of a library's pair.

    Raises:
        InvalidValueError: as ``statics``.
    """
    query = _held_query(mu, force, moment, point)
    path = path_of("v1", "histories", roll, pitch, "held")
    return get(path, ComputedHeld, **query, designation=designation, library=library, unit=unit)


def _held_query(
    mu: float | Iterable[float] | None,
    force: Sequence[float] | None,
    moment: Sequence[float] | None,
    point: Sequence[float] | None,
) -> dict[str, QueryValue]:
    query = load_query(None, force, moment, point)
    if mu is not None:
        given = [float(one) for one in ([mu] if isinstance(mu, int | float) else mu)]
        for one in given:
            checked_friction(one)
        query["mu"] = ",".join(map(number_text, given))
    return query


def solve_statics(
    poses: Iterable[tuple[float, float, float]],
    loads: Iterable[LoadToBear] = ({},),
    *,
    include: Iterable[str] = (),
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[StaticsAnswer]:
    """The statics of poses (roll, pitch, phase), on a grid or not, each under every load: 1 to 1000 of them.

    A load has ``force``, ``moment``, ``point`` and ``mu`` as for ``statics``, each with its default. What ``include``
    names is added; with modes there may be 10 at most. Of a known thread, or with the pair and the tolerances of
    ``library``.

    Raises:
        InvalidValueError: there are none or too many, or a load is not valid.
    """
    named = [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses]
    checked = [checked_load(load, f"loads {number} ") for number, load in enumerate(loads)]
    count = len(named) * len(checked)
    if not 1 <= count <= MOST_COMBINATIONS:
        raise InvalidValueError("poses times loads", count, f"1 to {MOST_COMBINATIONS}")
    body: dict[str, object] = {"designation": designation, "library": library, "poses": named, "loads": checked}
    added = list(include)
    if added:
        body["include"] = added
    # Nothing is stored: repeatable.
    return post(path_of("v1", "statics"), StaticsAnswer, body, repeatable=True, unit=unit)
