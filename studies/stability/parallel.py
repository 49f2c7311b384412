"""Work in processes, one a core: results come in the order of the tasks, whatever process did them."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol, TypeVar

from rich.progress import Progress

Task = TypeVar("Task")
Result = TypeVar("Result")

PRELOADED = ["studies.stability.findings"]


class Workers(Protocol):
    """Whatever does tasks and hands back the results in their order."""

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
