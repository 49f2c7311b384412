from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

CONSTANTS = """
from threadstate._compile import kernel

@kernel()
def callee(x, count, is_negative):
    return -(x * x + count) if is_negative else x * x + count

@kernel()
def caller(x, count):
    return callee(x, 1, True) + callee(x, 2, False) + callee(x, count, x > 0.0)

print(caller(3.0, 4), caller.py_func(3.0, 4), len(callee.signatures))
"""

ROUNDING = """
from threadstate._compile import kernel

@kernel(contract=CALLEE)
def callee(x):
    return x * x + 1.0

@kernel(contract=CALLER)
def caller(x):
    return callee(x) - 1.0

caller(3.0)
(code,) = callee.inspect_llvm().values()
print("fmul contract" in code, "fmul double" in code)
"""


def printed(code: str, folder: Path) -> list[str]:
    """What a process prints that compiles all it calls."""
    (folder / "kernels.py").write_text(code)
    environment = {**os.environ, "PYTHONPATH": str(Path.cwd()), "THREADSTATE_NUMBA_CACHE_DIR": str(folder)}
    run = subprocess.run(
        [sys.executable, folder / "kernels.py"], check=True, capture_output=True, text=True, env=environment
    )
    return run.stdout.split()


def test_calls_with_constants_share_one_specialisation(tmp_path: Path) -> None:
    compiled, interpreted, specialisations = printed(CONSTANTS, tmp_path)
    assert compiled == interpreted
    assert specialisations == "1"


def test_a_kernel_does_not_take_over_how_its_first_caller_rounds(tmp_path: Path) -> None:
    """Else the bits of one would depend on which of its callers a process compiles first."""
    for callee in (False, True):
        code = ROUNDING.replace("CALLEE", str(callee)).replace("CALLER", str(not callee))
        assert printed(code, tmp_path) == [str(callee), str(not callee)]
