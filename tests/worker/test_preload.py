from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

LOADED = """
import signal
import worker.preload
from threadstate.contact._solve_kernel import solve_rows
print(len(solve_rows.signatures), signal.getsignal(signal.SIGINT) is signal.SIG_IGN)
"""
WARM_UP = "from threadstate.warm_up import main; main()"


def _out(code: str, **environment: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env={**os.environ, **environment}
    )
    return run.stdout.strip()


def test_compiled_kernels_are_loaded() -> None:
    _out(WARM_UP)
    assert _out(LOADED) == "1 True"


def test_kernels_are_not_compiled_where_nothing_can_stop_it(tmp_path: Path) -> None:
    assert _out(LOADED, THREADSTATE_NUMBA_CACHE_DIR=str(tmp_path)) == "0 True"
    assert list(tmp_path.rglob("*.nbc")) == []


@pytest.mark.parametrize("needed", ["worker.cli", "worker.rebuild", "worker.progress"])
def test_the_writing_process_loads_no_numba(needed: str) -> None:
    assert _out(f"import sys, {needed}; print('{needed}' in sys.modules, 'numba' in sys.modules)") == "True False"
