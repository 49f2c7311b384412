"""The whole study: hard places under perturbation, the grid, the descents, and the pitfalls of meshes.

Work is done in processes, one a core; results come in the order of the tasks, whatever process did them.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol, TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from studies.methods import Case, MeshStates, Method
from studies.stability.demonstrations import Shown, demonstrations, shown
from studies.stability.descent_study import DESCENTS, DescentRow, Recheck, descent_row, recheck, wrong_heights
from studies.stability.events import Event, events_along, phase_line
from studies.stability.grid_study import GridRow, grid_row
from studies.stability.mesh_pitfalls import MeshPitfalls, mesh_pitfalls
from studies.stability.place_study import Chunk, study
from studies.stability.places import Place, lines, places, spread
from studies.stability.rival_study import RivalChunk, RivalTally, study_rival, thinned
from studies.stability.tally import Tally
from studies.stability.tangent_study import BesideAxis, beside_axes
from threadstate.library.grid import Grid
from threadstate.mesh.options import Descent
from threadstate.mesh.presets import Preset
from threadstate.thread.pair import Pair

Task = TypeVar("Task")
Result = TypeVar("Result")

PRELOADED = ["studies.stability.findings"]


class Workers(Protocol):
    """Anything that runs tasks and returns the results in their order."""

    def imap(self, func: Callable[[Task], Result], iterable: Iterable[Task], chunksize: int = 1) -> Iterator[Result]:
        """The results."""


class _ThisProcess:
    def imap(self, func: Callable[[Task], Result], iterable: Iterable[Task], chunksize: int = 1) -> Iterator[Result]:
        del chunksize
        return map(func, iterable)


@contextmanager
def workers(processes: int) -> Iterator[Workers]:
    """Processes that last for the whole study, so that each compiles the brute force once; 1 is this very process."""
    if processes == 1:
        yield _ThisProcess()
        return
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOADED)
    with context.Pool(processes) as pool:
        yield pool


def in_order(
    pool: Workers, work: Callable[[Task], Result], tasks: Sequence[Task], progress: Progress, title: str
) -> Iterator[Result]:
    """The results of all tasks in their order, with a bar that moves on as they come."""
    shown = progress.add_task(title, total=len(tasks))
    for result in pool.imap(work, tasks, chunksize=1):
        progress.advance(shown)
        yield result


@dataclass(frozen=True)
class RivalExtent:
    """A slower method, and how many centres of a place and trials of each it is given; whether it is demonstrated."""

    method: MeshStates
    centres: int
    trials: int
    demonstrated: bool = False


RIVAL_TURN_LIMIT_DEG = 10.0
"""Where turns end for the slower methods and the exact one beside them: on the way to 45 deg meshes take seconds."""

RIVALS = (
    RivalExtent(MeshStates(Preset.COARSE, Descent.SAFE), 1, 6),
    RivalExtent(MeshStates(Preset.COARSE, Descent.DECADES), 1, 6),
    RivalExtent(MeshStates(Preset.MEDIUM, Descent.SAFE), 1, 1, demonstrated=True),
    RivalExtent(MeshStates(Preset.MEDIUM, Descent.DECADES), 1, 1, demonstrated=True),
)


@dataclass(frozen=True)
class Extent:
    """How much is done: lines along which events are searched for, degrees of each, centres of a place, the grid.

    ``rivals`` and ``descents`` are slower methods, ``pitfall_poses`` poses whose colliding pairs are examined.
    ``trials`` is the most of a centre; all of them where it is None.
    """

    lines: int
    degrees: int
    centres: int
    grid: Grid
    rivals: tuple[RivalExtent, ...] = RIVALS
    descents: tuple[MeshStates, ...] = DESCENTS
    pitfall_poses: int = 200
    trials: int | None = None

    def chunks(self, place: Place) -> list[Chunk]:
        """The work at a hard place."""
        chunks = place.chunks()
        return chunks if self.trials is None else [_thinned(chunk, self.trials) for chunk in chunks]


@dataclass(frozen=True)
class Findings:
    """What was found; ``tallies`` are in the order of the places, ``rivals`` by method and then likewise."""

    extent: Extent
    places: tuple[Place, ...]
    tallies: tuple[Tally, ...]
    rows: tuple[GridRow, ...]
    axes: tuple[BesideAxis, ...]
    rivals: Mapping[str, tuple[RivalTally, ...]]
    descents: tuple[DescentRow, ...]
    rechecks: tuple[Recheck, ...]
    shown: tuple[Shown, ...]
    pitfalls: MeshPitfalls

    @property
    def total(self) -> Tally:
        """All places together."""
        total = Tally()
        for tally in self.tallies:
            total.add(tally)
        return total


def findings(exact: Method, pair: Pair, extent: Extent, processes: int) -> Findings:
    """Run the study, with progress bars on stderr."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("ETA"),
        TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    with Progress(*columns, console=console, refresh_per_second=2) as progress, workers(processes) as pool:
        along = partial(_events, exact, extent.degrees)
        found = in_order(pool, along, lines(pair, extent.lines), progress, "searching for events")
        hard = places(pair, [event for events in found for event in events], extent.centres)
        chunks = [chunk for place in hard for chunk in extent.chunks(place)]
        tallies = {place.name: Tally() for place in hard}
        results = in_order(pool, partial(study, exact), chunks, progress, "perturbing hard places")
        for chunk, tally in zip(chunks, results, strict=True):
            tallies[chunk.place].add(tally)
        orientations = range(extent.grid.orientation_count)
        row = partial(grid_row, exact, pair, extent.grid)
        rows = tuple(in_order(pool, row, orientations, progress, "mapping the grid"))
        descend = partial(descent_row, exact, extent.descents, pair, extent.grid)
        descents = tuple(in_order(pool, descend, orientations, progress, "descending by meshes"))
        wrong = list(wrong_heights(extent.descents, pair, descents))
        rechecks = tuple(in_order(pool, partial(recheck, exact), wrong, progress, "rechecking wrong heights"))
        rival_chunks = [chunk for rival in extent.rivals for place in hard for chunk in _rival_chunks(rival, place)]
        rivals = {rival.method.name: {place.name: RivalTally() for place in hard} for rival in extent.rivals}
        replies = in_order(pool, partial(study_rival, exact), rival_chunks, progress, "perturbing with meshes")
        for rival_chunk, rival_tally in zip(rival_chunks, replies, strict=True):
            rivals[rival_chunk.method.name][rival_chunk.place].add(rival_tally)
        others = [rival.method for rival in extent.rivals if rival.demonstrated]
        show = partial(shown, exact, others)
        demonstrated = tuple(in_order(pool, show, demonstrations(pair, hard), progress, "demonstrating"))
        (pitfalls,) = in_order(
            pool, partial(mesh_pitfalls, others[0], extent.pitfall_poses), [pair], progress, "measuring pitfalls"
        )
    return Findings(
        extent,
        tuple(hard),
        tuple(tallies.values()),
        rows,
        tuple(beside_axes()),
        {name: tuple(by_place.values()) for name, by_place in rivals.items()},
        descents,
        rechecks,
        demonstrated,
        pitfalls,
    )


def _events(method: Method, degrees: int, start: Case) -> list[Event]:
    return events_along(method, phase_line(start, degrees + 1))


def _thinned(chunk: Chunk, most: int) -> Chunk:
    of_centres = ([trial for trial in chunk.trials if trial.centre == i] for i in range(len(chunk.centres)))
    return replace(chunk, trials=tuple(trial for trials in of_centres for trial in thinned(trials, most)))


def _rival_chunks(rival: RivalExtent, place: Place) -> list[RivalChunk]:
    centres = [_with_short_turns(centre) for centre in spread(list(place.centres), rival.centres)]
    return [
        RivalChunk(rival.method, place.name, centre, thinned(place.trials_of([centre], number), rival.trials))
        for number, centre in enumerate(centres)
    ]


def _with_short_turns(case: Case) -> Case:
    return replace(case, options=replace(case.options, turn_limit_deg=RIVAL_TURN_LIMIT_DEG))
