from __future__ import annotations

import ast
import importlib
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType, NoneType
from typing import Any, get_args, get_origin, get_type_hints

CONSTANTS = """
from threadstate._compile import kernel

@kernel()
def callee(x, count, is_negative):
    return -(x * x + count) if is_negative else x * x + count

@kernel()
def caller(x, count):
    return callee(x, 1, True) + callee(x, 2, False) + callee(x, count, x > 0.0)

print(caller(3.0, 4), caller.py_func(3.0, 4), len(callee.as_callee().signatures))
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
(code,) = caller.inspect_llvm().values()
(subtracted,) = (line for line in code.splitlines() if line.endswith("-1.000000e+00"))
print("fmul contract" in code, "fadd contract" in subtracted)
"""


LINKED = """
import gc
from pathlib import Path
from numba import njit
from threadstate._compile import kernel

@kernel()
def deepest(x):
    return 3.0 * x

@kernel()
def between(x):
    total = 0.0
    while total < x:
        total += deepest(x) - 2.0 * x
BRANCHES
    return total + deepest(total)

@kernel()
def entry(x):
    return between(x) + between(2.0 * x)

plain = njit(lambda x: entry(x) + between(x))
print(entry(1.0), plain(1.0), gc.isenabled())
print(*(kernel.signatures for kernel in (deepest, between)))
print(*sorted(path.name.split("-")[0] for path in Path(FOLDER).rglob("*.nbi")))
(code,) = entry.inspect_llvm().values()
print(*(line.split()[1] for line in code.splitlines() if line.startswith("define") and "between" in line))
"""

LOADED = """
import sys
import numpy as np
from threadstate._compile import kernel

@kernel(allocates=True)
def callee(count):
    return np.ones(count).sum()

@kernel(allocates=True)
def later(count):
    return callee(count) + 0.5

print(callee(3), sum(callee.stats.cache_hits.values()), "numba.typed.typeddict" in sys.modules)
if len(sys.argv) > 1:
    print(later(3), callee(4))
"""

BRANCHES = "\n".join(f"    if total < -{i}.0:\n        total = deepest(total) / (total - {i}.5)" for i in range(1, 40))
"""Too many to be inlined."""

HALVES = """
import os
from numba.core import errors, event, ir, lowering, typeinfer
from numba.core.cpu import CPUContext
from numba.core.postproc import PostProcessor
from numba.core.types.functions import BaseFunction

PARTS = (
    (BaseFunction, "get_call_type"),
    (CPUContext, "load_additional_registries"),
    (PostProcessor, "run"),
    (errors, "new_error_context"),
    (event, "end_event"),
    (event, "start_event"),
    (ir.Inst, "_rec_list_vars"),
    (lowering, "new_error_context"),
    (typeinfer, "new_error_context"),
)
usual = [getattr(*part) for part in PARTS]

from threadstate._callee import _INSTEAD
from threadstate._compile import ahead, kernel
from threadstate.warm_up import compile_halves

@kernel()
def callee(x):
    return 3.0 * x

@kernel()
def entry(x):
    return callee(x) + 1.0

@kernel()
def other(x):
    return callee(x) + 2.0

def fails(types):
    raise OSError("no space")

def code_of(process):
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])

code = code_of(compile_halves(ahead(entry, 1.0)))
print(code, len(entry.signatures), entry(1.0), sum(entry.stats.cache_hits.values()))
compiles, other.compile = other.compile, fails
code = code_of(compile_halves(ahead(other, 1.0)))
other.compile = compiles
print(code, len(other.signatures), other(1.0), sum(other.stats.cache_hits.values()))
print(all(getattr(*part) is one for part, one in zip(PARTS, usual)) and len(PARTS) == len(_INSTEAD))
"""

FAILING = """
from numba.core.errors import TypingError

from threadstate._compile import kernel

@kernel()
def callee(x):
    return x.nothing

@kernel()
def entry(x):
    return callee(x)

try:
    entry(1.0)
except TypingError as error:
    print(*(line.split(" at ")[0] for line in str(error).splitlines() if line.startswith("During: typing")))
"""

SCRATCH = """
import numpy as np
from numba.core.errors import TypingError
from threadstate._compile import kernel
from threadstate._scratch import scratch

ROWS, COLUMNS = 3, 2

@kernel()
def fill(numbers, first):
    for i in range(numbers.shape[0]):
        for j in range(numbers.shape[1]):
            numbers[i, j] = first + 10.0 * i + j

@kernel()
def below(first):
    table = scratch(ROWS, COLUMNS)
    fill(table, first)
    return table[ROWS - 1, COLUMNS - 1]

@kernel()
def entry(first, out):
    table, row, none = scratch(ROWS, COLUMNS), scratch(4), scratch(0, 5)
    fill(table, first)
    deeper = below(100.0)
    for i in range(row.shape[0]):
        row[i] = i
    out[0], out[1], out[2] = table[2, 1], deeper, row[3]
    return table.shape[0] + table.shape[1] + row.shape[0] + none.shape[0] + none.shape[1]

@kernel()
def of_any_size(rows):
    return scratch(rows).shape[0]

for one in (entry, entry.py_func):
    out = np.zeros(3)
    print(one(1.0, out), *out)
try:
    of_any_size(3)
except TypingError as error:
    print("scratch(int64)" in str(error))
(code,) = entry.inspect_llvm().values()
print("NRT" in code)
"""

AHEAD = """
import sys
from threadstate import warm_up
from threadstate.device import compile as device

warm_up.compile_level()
for one in warm_up.kernels_ahead(serving=False):
    one.kernel.compile(one.types)
warm_up.load_kernels()
device.load_turning()
kernels = {
    f"{module}.{name}": kernel
    for module in list(sys.modules)
    if module.startswith("threadstate.") and module.endswith("_kernel")
    for name, kernel in vars(sys.modules[module]).items()
    if hasattr(kernel, "signatures") and kernel.py_func.__module__ == module
}
print(sum(1 for kernel in kernels.values() if kernel.signatures))
print(*(name for name, kernel in kernels.items() if len(kernel.signatures) > 1))
"""

MAKERS = ("empty", "zeros", "ones", "full", "array", "eye", "copy", "astype", "argsort")
"""What makes an array in a kernel."""

SCALARS = (int, float, bool, NoneType, Ellipsis)
"""What a type is made of that a kernel returns without giving its caller an array."""


def decorators(function: ast.FunctionDef) -> list[str]:
    """The decorators of a function that is a kernel, none of others."""
    return [text for text in map(ast.unparse, function.decorator_list) if text.startswith("kernel(")]


def is_scalar(kind: Any) -> bool:
    """Whether a type, of tuples and named tuples too, holds no array."""
    if hasattr(kind, "_fields"):
        return all(map(is_scalar, get_type_hints(kind).values()))
    return kind in SCALARS or (get_origin(kind) is tuple and all(map(is_scalar, get_args(kind))))


def hands_over_an_array(call: ast.Call, module: ModuleType) -> bool:
    """Whether a call in a kernel's module makes an array, or is of a kernel that returns one."""
    callee: Any = module
    for name in ast.unparse(call.func).split("."):
        callee = getattr(callee, name, None)
    if isinstance(call.func, ast.Attribute) and call.func.attr in MAKERS:
        return True
    return hasattr(callee, "py_func") and returns_an_array(callee)


def returns_an_array(dispatcher: Any) -> bool:
    """Whether a kernel returns an array, a new one or one of its caller's: it counts one more reference to it."""
    return not is_scalar(get_type_hints(dispatcher.py_func)["return"])


def printed(code: str, folder: Path, *arguments: str) -> list[str]:
    """What a process prints that compiles all it calls, or loads what one of the same code has compiled before."""
    path = folder / "kernels.py"
    if not path.exists() or path.read_text() != code:
        path.write_text(code)
    environment = {**os.environ, "PYTHONPATH": str(Path.cwd()), "THREADSTATE_NUMBA_CACHE_DIR": str(folder)}
    run = subprocess.run(
        [sys.executable, path, *arguments], check=True, capture_output=True, text=True, env=environment
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


def test_callees_are_linked_and_not_compiled_by_themselves(tmp_path: Path) -> None:
    """Only what Python calls is compiled and cached; what that calls is no function of its own to anyone else.

    A function that is no kernel may call them, too.
    """
    entry, plain, collects, *rest = printed(
        LINKED.replace("FOLDER", repr(str(tmp_path))).replace("BRANCHES", BRANCHES), tmp_path
    )
    assert (entry, plain, collects) == ("12.0", "16.0", "True")
    assert rest == ["[]", "[]", "kernels.entry", "internal"]


def test_machine_code_is_loaded_without_what_compiles_it(tmp_path: Path) -> None:
    """It takes a third of the time then; what is compiled in the same process afterwards links the callee's code."""
    assert printed(LOADED, tmp_path) == ["3.0", "0", "True"]
    assert printed(LOADED, tmp_path, "later") == ["3.0", "1", "False", "3.5", "4.0"]


def test_a_copy_of_the_process_makes_the_machine_code(tmp_path: Path) -> None:
    """The process finds it in the cache; where the copy fails it is made at the first call. numba is as it was then."""
    *made, failed, compiled, value, hits, is_usual = printed(HALVES, tmp_path)
    assert made == ["0", "0", "4.0", "1"]
    assert (failed, compiled, value, hits) == ("1", "0", "5.0", "0")
    assert is_usual == "True"


def test_scratch_is_on_the_stack_and_of_constant_size(tmp_path: Path) -> None:
    """Of every call its own, the same as in plain Python, and no reference is counted."""
    *numbers, says_so, counts = printed(SCRATCH, tmp_path)
    assert numbers == 2 * ["14", "22.0", "121.0", "3.0"]
    assert (says_so, counts) == ("True", "False")


def test_no_kernel_returns_an_array_that_ends_with_its_call() -> None:
    """One that makes scratch returns no array at all, and none is made anew of that of another."""
    making, faults = 0, []
    for path in sorted(Path("threadstate").rglob("_*_kernel.py")):
        module = importlib.import_module(".".join(path.with_suffix("").parts))
        for function in ast.parse(path.read_text()).body:
            if isinstance(function, ast.FunctionDef) and decorators(function):
                calls = [ast.unparse(node.func) for node in ast.walk(function) if isinstance(node, ast.Call)]
                making += "scratch" in calls
                if "scratch" in calls and returns_an_array(getattr(module, function.name)):
                    faults.append(f"{path.name}: {function.name}")
    assert making > 0
    assert faults == []


def test_an_error_says_what_was_compiled(tmp_path: Path) -> None:
    assert " ".join(printed(FAILING, tmp_path)) == "During: typing of get attribute During: typing of call"


def test_what_is_compiled_ahead_is_what_is_called() -> None:
    """Else all that a kernel calls is compiled once more, for arguments of another type, when it is first called."""
    run = subprocess.run([sys.executable, "-c", AHEAD], check=True, capture_output=True, text=True)
    called, *others = run.stdout.split()
    assert int(called) > 10
    assert others == []


def test_kernels_that_make_or_return_arrays_count_references() -> None:
    """An array that another makes, or is handed, would never be freed, and one that it returns be freed too early.

    Where an expression makes one numba itself refuses to compile it.
    """
    counting, faults = 0, []
    for path in sorted(Path("threadstate").rglob("_*_kernel.py")):
        module = importlib.import_module(".".join(path.with_suffix("").parts))
        for function in ast.parse(path.read_text()).body:
            if isinstance(function, ast.FunctionDef) and decorators(function):
                calls = [node for node in ast.walk(function) if isinstance(node, ast.Call)]
                counts = returns_an_array(getattr(module, function.name))
                counts = counts or any(hands_over_an_array(call, module) for call in calls)
                counting += counts
                if counts and "allocates=True" not in decorators(function)[0]:
                    faults.append(f"{path.name}: {function.name}")
    assert counting > 0
    assert faults == []
