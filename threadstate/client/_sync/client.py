# Made of _async/client.py by `make client`: edit that one.
"""The client that waits for its responses, and its lists, which come page by page."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, Self, TypeVar

from threadstate.client._sync.job import Job
from threadstate.client._sync.transport import Transport
from threadstate.client.call import LATEST, Call, LibraryName, PagedCall, describe_as
from threadstate.client.calls import jobs as job_calls
from threadstate.client.calls import libraries as library_calls
from threadstate.client.calls import network as network_calls
from threadstate.client.calls import settled as settled_calls
from threadstate.client.calls import states as state_calls
from threadstate.client.calls import statics as statics_calls
from threadstate.client.calls import success as success_calls
from threadstate.client.calls import threads as thread_calls
from threadstate.client.frames import to_pandas, to_polars
from threadstate.client.models.answer import Page
from threadstate.client.models.assemblies import Assembly
from threadstate.client.models.jobs import JobDocument
from threadstate.client.options import DEFAULT_RETRIES, DEFAULT_TIMEOUT_S, make_options
from threadstate.client.watching import AssemblyEvents, AssemblyWatcher

if TYPE_CHECKING:
    import pandas
    import polars

P = ParamSpec("P")
Item = TypeVar("Item")
Result = TypeVar("Result")


class Items(Generic[Item]):
    """A list; each iteration requests its pages again, one at a time as needed."""

    def __init__(self, transport: Transport, call: PagedCall[Item]) -> None:
        self._transport = transport
        self._call = call

    def __iter__(self) -> Iterator[Item]:
        for page in self.pages():
            for item in page.items:
                yield item

    def pages(self) -> Iterator[Page[Item]]:
        """The pages, with their other fields."""
        call: Call[Page[Item]] | None = self._call.first
        while call is not None:
            page = self._transport.send(call)
            yield page
            call = self._call.after(page)

    def to_pandas(self) -> pandas.DataFrame:
        """All of it as a frame of pandas (extra ``pandas``)."""
        return to_pandas([item for item in self], self._call.item)

    def to_polars(self) -> polars.DataFrame:
        """All of it as a frame of polars (extra ``polars``)."""
        return to_polars([item for item in self], self._call.item)


def _answered(
    describe: Callable[P, Call[Result]],
) -> Callable[Concatenate[Client, P], Result]:
    """The method that sends the described call and returns its result."""

    def method(self: Client, /, *args: P.args, **kwargs: P.kwargs) -> Result:
        return self._transport.send(describe(*args, **kwargs))

    describe_as(method, describe)
    return method


def _listed(describe: Callable[P, PagedCall[Item]]) -> Callable[Concatenate[Client, P], Items[Item]]:
    """The method that returns the described list."""

    def method(self: Client, /, *args: P.args, **kwargs: P.kwargs) -> Items[Item]:
        return Items(self._transport, describe(*args, **kwargs))

    describe_as(method, describe, "Items[{}]")
    return method


def _watched(
    describe: Callable[P, Call[JobDocument]],
) -> Callable[Concatenate[Client, P], Job]:
    """The method that sends the described call and returns its job."""

    def method(self: Client, /, *args: P.args, **kwargs: P.kwargs) -> Job:
        return Job(self._transport, self._transport.send(describe(*args, **kwargs)))

    describe_as(method, describe, "Job")
    return method


class Client:
    """A client of the service at ``address`` (None: ``THREADSTATE_SERVICE``); a context manager.

    ``key`` (None: ``THREADSTATE_KEY``) is sent in the header ``Authorization``, to this address alone. ``timeout_s``
    is the longest time without data from the service. Requests that may be repeated are retried ``retries`` times. May
    be used by several threads.

    Raises:
        InvalidValueError: an argument or a setting is not valid.
    """

    def __init__(
        self,
        address: str | None = None,
        *,
        key: str | None = None,
        timeout_s: float = DEFAULT_TIMEOUT_S,
        retries: int = DEFAULT_RETRIES,
    ) -> None:
        self._transport = Transport(make_options(address, key, timeout_s, retries))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._transport.options})"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._transport.close()

    libraries = _answered(library_calls.libraries)
    library = _answered(library_calls.library)
    building = _answered(library_calls.building)
    orientations = _answered(library_calls.orientations)
    compare = _answered(library_calls.compare)
    mesh = _answered(library_calls.mesh)

    state = _answered(state_calls.state)
    states = _listed(state_calls.states)
    undecided = _listed(state_calls.undecided)
    history = _answered(state_calls.history)
    history_columns = _answered(state_calls.history_columns)
    history_csv = _answered(state_calls.history_csv)
    solve = _answered(state_calls.solve)

    statics = _answered(statics_calls.statics)
    solve_statics = _answered(statics_calls.solve_statics)
    jamming = _answered(statics_calls.jamming)
    computed_jamming = _answered(statics_calls.computed_jamming)
    jamming_svg = _answered(statics_calls.jamming_svg)
    held = _answered(statics_calls.held)
    computed_held = _answered(statics_calls.computed_held)

    settle = _answered(settled_calls.settle)
    ask_settled = _watched(settled_calls.ask_settled)
    settled_libraries = _answered(settled_calls.settled_libraries)
    settled_library = _answered(settled_calls.settled_library)
    settled_states = _listed(settled_calls.settled_states)
    settled_state = _answered(settled_calls.settled_state)

    outcomes = _answered(success_calls.outcomes)
    ask_success_map = _watched(success_calls.ask_success_map)
    success_maps = _answered(success_calls.success_maps)
    success_map = _answered(success_calls.success_map)
    success_orientations = _listed(success_calls.success_orientations)
    success_orientation = _answered(success_calls.success_orientation)
    growing_map = _answered(success_calls.growing_map)

    intervals = _answered(network_calls.intervals)
    heights = _answered(network_calls.heights)
    computed_intervals = _answered(network_calls.computed_intervals)
    computed_heights = _answered(network_calls.computed_heights)
    computed_falls = _answered(network_calls.computed_falls)
    windows = _answered(network_calls.windows)
    transitions = _listed(network_calls.transitions)
    network = _answered(network_calls.network)
    loaded_network = _answered(network_calls.loaded_network)
    network_node_link = _answered(network_calls.network_node_link)
    network_graphml = _answered(network_calls.network_graphml)
    network_dot = _answered(network_calls.network_dot)
    formations = _answered(network_calls.formations)
    formation = _answered(network_calls.formation)
    path = _answered(network_calls.path)
    locate = _answered(network_calls.locate)

    threads = _answered(thread_calls.threads)
    profiles_svg = _answered(thread_calls.profiles_svg)

    ask = _watched(job_calls.ask)
    jobs = _listed(job_calls.jobs)
    job = _watched(job_calls.job)

    health = _answered(library_calls.health)
    readiness = _answered(library_calls.readiness)

    def assemble(
        self,
        roll: float,
        pitch: float,
        phase: float,
        *,
        strategy: str | None = None,
        mu: float | None = None,
        longest_step: float | None = None,
        confirm: bool = False,
        device: Mapping[str, Any] | None = None,
        designation: str | None = None,
        library: LibraryName | None = None,
        unit: str | None = None,
        progress: AssemblyWatcher | None = None,
    ) -> Assembly:
        """The path of a bolt that a ``device`` settles at a pose and turns, and whether it engages.

        ``strategy`` is ``ccw_then_cw`` (None) or ``cw``, ``mu`` the friction of all contacts (None: 0),
        ``longest_step`` that of the phase in degrees, 0.25 to 2 (None: 2, with friction 1); with
        ``confirm`` half of it is followed as well, and the path flagged where that changes it; the others are as for
        :meth:`settle`. ``progress`` is called with how far the path is whenever that changes; what it raises
        ends the request, and the service stops.
        """
        call = settled_calls.assemble(
            roll,
            pitch,
            phase,
            strategy=strategy,
            mu=mu,
            longest_step=longest_step,
            confirm=confirm,
            device=device,
            designation=designation,
            library=library,
            unit=unit,
        )
        if progress is None:
            return self._transport.send(call)
        events = AssemblyEvents(call, progress)
        self._transport.events(events.call, events.received)
        return events.answer()

    def export(
        self,
        table: str,
        path: str | Path,
        *,
        file_format: str | None = None,
        library: LibraryName = LATEST,
        unit: str | None = None,
    ) -> Path:
        """Write a table of a library to a file, atomically.

        ``file_format`` is ``parquet``, ``csv`` or ``ndjson``; None is that of the file name's ending.

        Returns:
            The file.
        """
        out = Path(path)
        call = library_calls.export(table, file_format or out.suffix[1:], library=library, unit=unit)
        self._transport.download(call, out)
        return out
