"""The work of a path begins as zeros: what memory held before decides nothing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device._modes_kernel import new_modes_work
from threadstate.device._places_kernel import S_AZIMUTHS, Threads, new_threads
from threadstate.device._rest_kernel import new_work
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow


def fill_what_is_free() -> None:
    """Leave numbers in memory that is given back, for arrays of each size to come."""
    for size in 2 ** np.arange(1, 16):
        kept = [np.full(size, 0.5) for _ in range(8)]
        del kept


def arrays_of_a_path() -> list[NDArray[np.generic]]:
    """All arrays but the grid, whose columns are set."""
    fill_what_is_free()
    modes, rest = new_modes_work.py_func(), new_work.py_func()
    threads = Threads(*new_threads(quarter_twenty_unc().bolt.packed))
    assert threads.samples[S_AZIMUTHS] > 0.0
    threads.samples[S_AZIMUTHS] = 0.0
    return [*modes, *rest, *threads[1:]]


def test_the_work_of_a_path_begins_as_zeros() -> None:
    assert not any(array.any() for array in arrays_of_a_path())
