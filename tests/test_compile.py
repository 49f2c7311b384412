from __future__ import annotations

import ast
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

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


MAKERS = ("empty", "zeros", "ones", "full", "array", "eye", "copy", "astype", "argsort")
"""What makes an array in a kernel."""

SCALARS = {"int", "float", "bool", "tuple", "None", "Numbers", "Pair", "Crossing"}
"""Names in the types that a kernel returns without giving its caller an array."""


def is_borrower(function: ast.FunctionDef) -> bool:
    """Whether a function is a kernel that counts no references."""
    return any("allocates=False" in ast.unparse(decorator) for decorator in function.decorator_list)


def hands_over_an_array(call: ast.Call, module: ModuleType) -> bool:
    """Whether a call in a kernel's module makes an array, or is of a kernel that may return one."""
    if isinstance(call.func, ast.Attribute):
        return call.func.attr in MAKERS
    callee: Any = getattr(module, ast.unparse(call.func), None)
    if not hasattr(callee, "py_func"):
        return False
    return not set(re.findall(r"\w+", callee.py_func.__annotations__["return"])) <= SCALARS


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


def test_a_kernel_that_counts_no_references_makes_no_arrays() -> None:
    """Nor do those that it calls hand it any: they would never be freed."""
    borrowers, faults = 0, []
    for path in sorted(Path("threadstate").rglob("_*_kernel.py")):
        module = importlib.import_module(".".join(path.with_suffix("").parts))
        for function in ast.parse(path.read_text()).body:
            if isinstance(function, ast.FunctionDef) and is_borrower(function):
                borrowers += 1
                calls = [node for node in ast.walk(function) if isinstance(node, ast.Call)]
                faults += [function.name for call in calls if hands_over_an_array(call, module)]
    assert borrowers > 0
    assert faults == []
