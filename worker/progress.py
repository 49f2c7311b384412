"""The progress bar of a rebuild: poses done, poses per second, time left; on stderr."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TaskID, TextColumn, track
from rich.progress import TimeRemainingColumn as TimeLeftColumn
from rich.text import Text


class PosesPerSecond(ProgressColumn):
    """The mean rate of this run."""

    def render(self, task: Task) -> Text:
        """The rate, once there is one."""
        rate = task.finished_speed or task.speed
        return Text("-- poses/s" if rate is None else f"{rate:,.0f} poses/s")


class ProgressBar:
    """The progress bar of a rebuild; see :class:`worker.rebuild.Progress`."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None

    def begin(self, committed: int, total: int) -> None:
        """Announce the kernels: the first run on a machine compiles them, which takes a while."""
        if committed:
            self._progress.console.print(f"resuming after {committed} poses of an earlier run", highlight=False)
        self._task = self._progress.add_task(
            "loading kernels (a first run compiles them)", total=total, completed=committed, start=False
        )

    def ready(self) -> None:
        """Start the clock."""
        if self._task is not None:
            self._progress.update(self._task, description="computing")
            self._progress.start_task(self._task)

    def advance(self, poses: int) -> None:
        """Move on."""
        if self._task is not None:
            self._progress.advance(self._task, poses)


Item = TypeVar("Item")


def with_progress(items: Iterable[Item], name: str, count: int | None = None) -> Iterable[Item]:
    """The same items, with a progress bar on stderr during the iteration if it is a terminal.

    ``count`` is their number, if the items have no length.
    """
    console = Console(stderr=True)
    return track(
        items, name, count, console=console, refresh_per_second=5, transient=True, disable=not console.is_terminal
    )


@contextmanager
def progress_bar() -> Iterator[ProgressBar]:
    """A progress bar on stderr, drawn while the context lasts; only its last line if stderr is not a terminal."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        PosesPerSecond(),
        TextColumn("ETA"),
        TimeLeftColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), refresh_per_second=5) as progress:
        yield ProgressBar(progress)
