"""Loads the kernels on import, which the forkserver does.

Kernels that are not compiled yet are left to the computing processes: it takes a minute, in which those can be
terminated.
Errors are ignored here: they occur again in the computing processes, which report them.
"""

from __future__ import annotations

import contextlib
import gc
import signal

from worker.garbage import collect_rarely

# SIGINT reaches the whole process group; the parent alone handles it.
signal.signal(signal.SIGINT, signal.SIG_IGN)

collect_rarely()
with contextlib.suppress(Exception):
    import worker.compute  # noqa: F401 - for the computing processes
    from threadstate.warm_up import kernels_are_compiled, load_kernels

    if kernels_are_compiled():
        load_kernels()
gc.freeze()  # all objects so far live as long as the process
