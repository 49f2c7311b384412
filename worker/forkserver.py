"""The forkserver from which computing processes are forked: a clean process with the kernels loaded."""

from __future__ import annotations

import multiprocessing
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext
from pathlib import Path

PRELOADED = ["worker.preload", "worker.cli", "__main__"]
"""Modules that it imports. The command line is one of them, as every process imports the program that started it."""

_SQLITE = "sqlite:///"


def running_forkserver() -> ForkServerContext:
    """Start the forkserver unless it runs, without waiting until it is ready.

    Returns:
        The context whose processes it forks.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOADED)
    forkserver.ensure_running()
    return context


def start_for(database: str) -> None:
    """Start the forkserver where it is certain to be needed: nothing is published in a SQLite file that is not there.

    It loads the kernels while this process imports what the database takes, a second of work for each.
    """
    path = database.removeprefix(_SQLITE)
    if path != database and not Path(path).exists():
        running_forkserver()
