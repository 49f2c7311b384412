"""What many tests need and takes long to compute: computed once in a run, by the first of its processes to need it."""

from __future__ import annotations

import fcntl
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

FOLDER = "THREADSTATE_TESTS_SHARED"
"""The environment variable that names the folder of the values of a run; set by ``tests/conftest.py``."""


def computed_once(name: str, compute: Callable[[], T]) -> T:
    """The value of that name: computed by one process of a test run, read by the others; outside a run computed."""
    if FOLDER not in os.environ:
        return compute()
    path = Path(os.environ[FOLDER]) / f"{name}.pickle"
    with path.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            value = compute()
            written = path.with_suffix(".written")
            written.write_bytes(pickle.dumps(value))
            written.rename(path)
            return value
    found: T = pickle.loads(path.read_bytes())
    return found
