"""How the code of a kernel becomes part of that of its callers (docs/decisions/0064-callees-are-linked.md).

numba optimises each function together with all that it calls, and makes machine code of both, before another calls it:
what is called deep down is compiled again within every function above it. Here a callee's code is left as it is
lowered, and linked with all that it calls into that of the kernel that Python calls, which is compiled once.

It looks up again, at each place of a call, which of an operator's implementations takes arguments of these types. Here
that is remembered, and passes for what no kernel has are left out (docs/decisions/0069-compilation-in-less-time.md).
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from llvmlite.binding import Linkage
from numba import types
from numba.core import untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import InlineOverloads, NativeLowering
from numba.core.types.functions import BaseFunction

_WITHOUT = {
    InlineOverloads,
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
"""Passes for functions within functions, blocks of ``with``, calls that are pasted in, branches on constants."""

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


@contextmanager
def _signatures_remembered() -> Iterator[None]:
    """Numba's lock of its compiler is held meanwhile: no other thread compiles."""
    outer = _own_function.get_call_type
    _own_function.get_call_type = _remembered
    try:
        yield
    finally:
        _own_function.get_call_type = outer


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


def _pipeline(lowering: type[NativeLowering]) -> type[CompilerBase]:
    """Numba's compiler with another way of lowering."""

    class Pipeline(CompilerBase):
        def compile_extra(self, func: Any) -> Any:
            """Compile at less cost."""
            with _without_garbage_collection(), _signatures_remembered():
                return super().compile_extra(func)

        def define_pipelines(self) -> list[PassManager]:
            """The usual passes without some, and one replaced."""
            passes = PassManager(lowering.name())
            for one, description in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
                if one not in _WITHOUT:
                    passes.add_pass(lowering if one is NativeLowering else one, description)
            passes.finalize()
            return [passes]

    return Pipeline


ENTRY = _pipeline(_EntryLowering)
"""The compiler of a kernel that Python calls."""

CALLEE = _pipeline(_CalleeLowering)
"""The compiler of one that kernels call."""


def let_kernels_call(entry: Any, callee: Any) -> None:
    """Let kernels that call the dispatcher ``entry`` link the code of ``callee``, of the same function.

    A call with constants shares the one specialisation: numba makes another for every constant of a caller.
    """

    def get_call_template(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return callee.get_call_template(
            tuple(map(types.unliteral, args)), {name: types.unliteral(one) for name, one in kws.items()}
        )

    def add_overload(result: Any) -> None:
        callee.overloads[tuple(result.signature.args)] = result

    callee.add_overload = add_overload
    entry.get_call_template, entry.get_overload = get_call_template, callee.get_overload
    entry.as_callee = callee
