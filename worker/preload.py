"""Loads the kernels when it is imported, which the forkserver does.

Where they are still to be compiled nothing is done: that takes a minute, and a computing process can be ended in it.
What goes wrong here goes wrong again in the computing processes, which can tell.
"""

from __future__ import annotations

import contextlib
import gc
import signal

from worker.garbage import collect_rarely

# Ctrl-C reaches the whole group; the parent alone decides what it means.
signal.signal(signal.SIGINT, signal.SIG_IGN)

collect_rarely()
with contextlib.suppress(Exception):
    import worker.compute  # noqa: F401 - for the computing processes
    from threadstate.warm_up import kernels_are_compiled, load_kernels

    if kernels_are_compiled():
        load_kernels()
gc.freeze()  # what is here now stays for good
