from __future__ import annotations

import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

AFTER_THAT_NOTHING_COMPILES = """
import gc
import pickle
from collections import Counter
import numpy as np
from numba.core.registry import CPUDispatcher
from threadstate.history.build import history_of
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from threadstate.warm_up import main

def compiled():
    signatures = Counter()
    for one in gc.get_objects():
        if isinstance(one, CPUDispatcher):
            signatures[f"{one.py_func.__module__}.{one.py_func.__name__}"] += len(one.signatures)
    return signatures

main()
warm = compiled()
print(len(warm), sum(warm.values()))
level = [(0.0, 0.0, phase) for phase in np.arange(-3.0, 3.0, 0.25)] + [(0.0, 0.0, 180.0)]
tilted = np.random.default_rng(6).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (40, 3))
for pair in (quarter_twenty_unc(), quarter_twenty_unc(RootForm.NEWER)):
    solve_poses(pair, np.vstack([level, tilted]))
    solve_poses(pair, [])
    history_of(pair, 3.0, -1.0)
    solve_poses(pickle.loads(pickle.dumps(pair)), [(0.0, 0.0, 0.0), (4.0, 0.0, 185.0)])
print(sorted(set(compiled().items()) - set(warm.items())))
"""


def test_after_the_warm_up_nothing_is_compiled() -> None:
    run = subprocess.run(
        [sys.executable, "-c", AFTER_THAT_NOTHING_COMPILES], check=True, capture_output=True, text=True
    )
    first, last, counts, new = run.stdout.splitlines()
    assert first.startswith(("Loading the kernels from", "Compiling the kernels into"))
    assert last.startswith("Kernels ready after")
    kernels, signatures = map(int, counts.split())
    assert kernels > 20
    assert signatures > 5
    assert new == "[]"


COMPILES_FOR_A_WHILE = """
import time
from threadstate import warm_up

def compile_for_a_while():
    print(time.monotonic())
    time.sleep(0.3)
    print(time.monotonic())

warm_up.load_kernels = compile_for_a_while
warm_up.load_kernels_exclusively()
"""


def test_one_process_compiles_at_a_time(tmp_path: Path) -> None:
    environment = {**os.environ, "THREADSTATE_NUMBA_CACHE_DIR": str(tmp_path)}
    running = [
        subprocess.Popen([sys.executable, "-c", COMPILES_FOR_A_WHILE], env=environment, stdout=subprocess.PIPE)
        for _ in range(3)
    ]
    turns = sorted(tuple(map(float, process.communicate()[0].split())) for process in running)
    assert [process.returncode for process in running] == [0, 0, 0]
    assert all(end <= begin for (_, end), (begin, _) in pairwise(turns))


COMPILES_FOR_AN_HOUR = """
import time
from threadstate.warm_up import in_a_copy, wait_for

def compile_for_an_hour():
    inner = in_a_copy(lambda: time.sleep(3600.0))
    print("compiling", flush=True)
    wait_for([inner])

wait_for([in_a_copy(compile_for_an_hour)])
"""


def test_copies_that_compile_end_with_the_process_that_wants_them() -> None:
    """Killed, it can tell them nothing: the pipe that they have inherited ends with the last of them."""
    with subprocess.Popen([sys.executable, "-c", COMPILES_FOR_AN_HOUR], stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "compiling\n"
        running.kill()
        assert running.communicate(timeout=60.0)[0] == ""


def test_a_copy_says_that_it_failed() -> None:
    program = "from threadstate.warm_up import in_a_copy; import os; print(os.waitpid(in_a_copy(lambda: 1 / 0), 0)[1])"
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert os.waitstatus_to_exitcode(int(run.stdout)) == 1
    assert "ZeroDivisionError" in run.stderr
