"""How the code of a kernel becomes part of that of its callers (docs/decisions/0064-callees-are-linked.md).

numba optimises each function together with all that it calls, and makes machine code of both, before another calls it:
what is called deep down is compiled again within every function above it. Here a callee's code is left as it is
lowered, and linked with all that it calls into that of the kernel that Python calls, which is compiled once.

It looks up again, at each place of a call, which of an operator's implementations takes arguments of these types. Here
that is remembered, and passes for what no kernel has are left out (docs/decisions/0069-compilation-in-less-time.md).
So is what it finds out about kernels and no pass asks for (docs/decisions/0071-nothing-compiled-twice.md).
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from typing import Any
from weakref import WeakSet

from llvmlite.binding import Linkage, parse_assembly
from numba import types
from numba.core import errors, event, ir, lowering, typeinfer, untyped_passes
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.cpu import CPUContext
from numba.core.errors import NumbaError
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.runtime.nrt import rtsys
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import InlineOverloads, NativeLowering, NopythonRewrites
from numba.core.types.functions import BaseFunction

_WITHOUT = {
    InlineOverloads,
    NopythonRewrites,
    untyped_passes.DeadBranchPrune,
    untyped_passes.FindLiterallyCalls,
    untyped_passes.InlineClosureLikes,
    untyped_passes.InlineInlinables,
    untyped_passes.LiteralPropagationSubPipelinePass,
    untyped_passes.LiteralUnroll,
    untyped_passes.MakeFunctionToJitFunction,
    untyped_passes.RewriteDynamicRaises,
    untyped_passes.RewriteSemanticConstants,
    untyped_passes.WithLifting,
}
"""Passes for functions within functions, blocks of ``with``, calls that are pasted in, branches on constants, and sums
of arrays in one loop."""

_signatures: dict[tuple[Any, ...], Any] = {}
_own_function: Any = BaseFunction
"""The type of numba's own functions; its type takes no other method."""
_look_up = _own_function.get_call_type


def _remembered(function: Any, context: Any, args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
    """The signature of a call of one of numba's own functions: it follows from the types."""
    if kws:
        return _look_up(function, context, args, kws)
    call = function, *args
    if call not in _signatures:
        _signatures[call] = _look_up(function, context, args, kws)
    return _signatures[call]


_post_process = PostProcessor.run


def _without_live_variables(processor: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """Look at which variables live where only if that is to be written into the code; a kernel is no generator."""
    if emit_dels:
        _post_process(processor, emit_dels, extend_lifetimes)
        return
    of_kernel = processor.func_ir
    of_kernel.blocks = canonicalize_cfg(of_kernel.blocks)
    of_kernel.variable_lifetime = VariableLifetime(of_kernel.blocks)
    of_kernel.generator_info = None


_variables_by_type: dict[type, Callable[[Any], list[Any]]] = {}


def _variables(value: Any) -> list[Any]:
    """The variables of a part of an instruction, told by its type alone."""
    kind = type(value)
    if kind not in _variables_by_type:
        _variables_by_type[kind] = _variables_of(kind)
    return _variables_by_type[kind](value)


def _variables_of(kind: type) -> Callable[[Any], list[Any]]:
    if issubclass(kind, ir.Var):
        return lambda value: [value]
    if issubclass(kind, ir.Inst):
        return lambda value: value.list_vars()
    if issubclass(kind, (list, tuple)):
        return lambda value: [one for part in value for one in _variables(part)]
    if issubclass(kind, dict):
        return lambda value: [one for part in value.values() for one in _variables(part)]
    return lambda _: []


class _ErrorContext:
    """What is said of an error that is raised within, without a generator for each instruction."""

    def __init__(self, message: str, *args: object, **kwargs: object) -> None:
        self._message, self._args, self._kwargs = message, args, kwargs

    def __enter__(self) -> None: ...

    def __exit__(self, _kind: object, error: object, _trace: object) -> None:
        if isinstance(error, NumbaError):
            error.add_context(self._message.format(*self._args, **self._kwargs))


_load_registries = CPUContext.load_additional_registries
_loaded: WeakSet[Any] = WeakSet()


def _load_registries_once(context: Any) -> None:
    """Load numba's own implementations, which do not change."""
    if context not in _loaded:
        _load_registries(context)
        _loaded.add(context)


_INSTEAD = (
    (_own_function, "get_call_type", _remembered),
    (event, "start_event", lambda *_, **__: None),
    (event, "end_event", lambda *_, **__: None),
    (errors, "new_error_context", _ErrorContext),
    (lowering, "new_error_context", _ErrorContext),
    (typeinfer, "new_error_context", _ErrorContext),
    (CPUContext, "load_additional_registries", _load_registries_once),
    (PostProcessor, "run", _without_live_variables),
    (ir.Inst, "_rec_list_vars", lambda _, value: _variables(value)),
)
"""What does the same in less time as far as kernels need it: nothing is told of how long a lock of LLVM was held."""


@contextmanager
def _replaced(owner: Any, name: str, instead: Any) -> Iterator[None]:
    outer = getattr(owner, name)
    setattr(owner, name, instead)
    try:
        yield
    finally:
        setattr(owner, name, outer)


@contextmanager
def _less_bookkeeping() -> Iterator[None]:
    """Numba's lock of its compiler is held meanwhile: no other thread compiles."""
    with ExitStack() as stack:
        for one in _INSTEAD:
            stack.enter_context(_replaced(*one))
        yield


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """It takes a quarter of the time and finds little."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


class _EntryLibrary(JITCodeLibrary):
    """The code of a kernel that Python calls, with all that it calls."""

    def _optimize_final_module(self) -> None:
        """Optimise callees as functions that nothing else calls: their arguments too, and none is left unused.

        They get names of their own: LLVM's linker would hand them to another's code that looks for the same name.
        """
        defined = [one for one in self._final_module.functions if not one.is_declaration]
        (entry, *_) = (one.name for one in defined if one.linkage == Linkage.external)
        for one in defined:
            if one.linkage == Linkage.linkonce_odr:
                one.linkage = Linkage.internal
        super()._optimize_final_module()
        for one in self._final_module.functions:
            if one.linkage == Linkage.internal:
                one.name = f"{one.name}.{entry}"

    def _get_module_for_linking(self) -> Any:
        """The names alone of what is looked for in the machine code: kernels link the code of callees.

        What linked it all the same would end the process, and not go on with nothing computed.
        """
        self._ensure_finalized()
        if self._shared_module is None:
            defined = (one for one in self._final_module.functions if not one.is_declaration)
            names = [one.name for one in defined if one.linkage == Linkage.external]
            ends = [f'define void @"{name}"() {{ call void @llvm.trap() unreachable }}' for name in names]
            self._shared_module = parse_assembly("\n".join(["declare void @llvm.trap()", *ends]))
        return self._shared_module


class EntryCache(FunctionCache):
    """The cache of a kernel that Python calls."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load machine code, which takes nothing of what numba knows of types: a compiler asks for that itself."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)


class _CalleeLibrary(JITCodeLibrary):
    """The code of a kernel that kernels call, as it is lowered; its libraries are those of all that it calls."""

    def add_linking_library(self, library: Any) -> None:
        """Add a callee, then what that calls: a linker leaves out what nothing refers to yet."""
        callees = library._linking_libraries if isinstance(library, _CalleeLibrary) else ()
        for one in (library, *callees):
            if one not in self._linking_libraries:
                super().add_linking_library(one)

    def finalize(self) -> None:
        """Close it without linking, optimising or making machine code."""
        self._raise_if_finalized()
        self._finalized = True

    def _own_module(self) -> Any:
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """The code of all that it calls, too."""
        module = self._own_module().clone()
        for one in self._linking_libraries:
            code = one._own_module() if isinstance(one, _CalleeLibrary) else one._get_module_for_linking()
            module.link_in(code, preserve=True)
        return module


@register_pass(mutates_CFG=True, analysis_only=False)
class _EntryLowering(NativeLowering):
    _name = "entry_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower a kernel that Python calls."""
        state.library = _EntryLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class _CalleeLowering(NativeLowering):
    _name = "callee_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower a kernel that kernels call, and let these find it by an object of its own."""
        state.library = _CalleeLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        entry_point = object()
        state.targetctx.insert_user_function(entry_point, state["cr"].fndesc, [state.library])
        state["cr"] = state["cr"]._replace(cfunc=entry_point)
        return True


def _pipeline(lowers: type[NativeLowering]) -> type[CompilerBase]:
    """Numba's compiler with another way of lowering."""

    class Pipeline(CompilerBase):
        def compile_extra(self, func: Any) -> Any:
            """Compile at less cost."""
            with _without_garbage_collection(), _less_bookkeeping():
                return super().compile_extra(func)

        def define_pipelines(self) -> list[PassManager]:
            """The usual passes without some, and one replaced."""
            passes = PassManager(lowers.name())
            for one, description in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
                if one not in _WITHOUT:
                    passes.add_pass(lowers if one is NativeLowering else one, description)
            passes.finalize()
            return [passes]

    return Pipeline


ENTRY = _pipeline(_EntryLowering)
"""The compiler of a kernel that Python calls."""

CALLEE = _pipeline(_CalleeLowering)
"""The compiler of one that kernels call."""


def let_kernels_call(entry: Any, make_callee: Callable[[], Any]) -> None:
    """Let kernels that call the dispatcher ``entry`` link the code of another one, of the same function.

    That is made when the first one is compiled: a process that loads machine code needs none. A call with constants
    shares the one specialisation: numba makes another for every constant of a caller.
    """

    @cache
    def as_callee() -> Any:
        callee = make_callee()

        def add_overload(result: Any) -> None:
            callee.overloads[tuple(result.signature.args)] = result

        callee.add_overload = add_overload
        return callee

    def get_call_template(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return as_callee().get_call_template(
            tuple(map(types.unliteral, args)), {name: types.unliteral(one) for name, one in kws.items()}
        )

    entry.get_call_template = get_call_template
    entry.get_overload = lambda signature: as_callee().get_overload(signature)
    entry.as_callee = as_callee
