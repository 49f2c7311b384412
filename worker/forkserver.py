"""The forkserver: a clean process with the kernels loaded, of which every computing process is a copy."""

from __future__ import annotations

import multiprocessing
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext

PRELOADED = ["worker.preload", "worker.cli", "__main__"]
"""What it imports. The command line is there because every process imports the program that it was started by."""


def running_forkserver() -> ForkServerContext:
    """Start the forkserver unless it runs, and do not wait until it is ready.

    Returns:
        What makes processes that it forks.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOADED)
    forkserver.ensure_running()
    return context
