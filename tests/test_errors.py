"""Errors say the same in another process: a pool, or a Dask worker, sends them as pickles."""

from __future__ import annotations

import importlib
import inspect
import pickle
import re
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from types import FunctionType
from typing import Any, get_type_hints

import pytest

from service.problems import INVALID_VALUE, Kind
from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.libraries import GridDocument
from threadstate.client.models.service import Problem
from threadstate.jobs.names import JobKind, JobState
from threadstate.library.solver_method import SolverMethod

ROOMS = ("threadstate", "worker", "service", "migrations")
ROOT = Path(__file__).parents[1]

_NOW = datetime(2026, 1, 2, tzinfo=UTC)
_JOB = JobDocument(
    id=1,
    kind=JobKind.LIBRARY,
    state=JobState.FAILED,
    reason="a failure",
    designation="1/4-20 UNC",
    method=SolverMethod.EXACT,
    device=None,
    grid=GridDocument(tilt_max=0.0, tilt_step=1.0, phase_step=1.0, orientations=1),
    options={},
    input_sha256="0",
    code_version="0",
    chunks=1,
    committed=0,
    at_work=0,
    library=None,
    result=None,
    asked_at=_NOW,
    ended_at=_NOW,
)
ARGUMENTS: dict[Any, object] = {
    str: "some words",
    object: ("any", 1),
    float: -1.5,
    float | None: 2.5,
    bool: True,
    Kind: INVALID_VALUE,
    Problem: Problem(type="about:blank", title="Not found", status=404, detail="there is none"),
    JobDocument: _JOB,
}
"""An argument of every type that an error takes."""


def _modules() -> Iterator[str]:
    """The modules that define an error."""
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            if re.search(r"^class \w+\(.*(Error|Exception|Exit|Interrupt)\b.*\)", path.read_text(), re.M):
                yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def _subclasses(kind: type[BaseException]) -> Iterator[type[BaseException]]:
    for one in type.__subclasses__(kind):
        yield one
        yield from _subclasses(one)


def _errors() -> list[type[BaseException]]:
    for name in _modules():
        importlib.import_module(name)
    found = {one for one in _subclasses(BaseException) if one.__module__.partition(".")[0] in ROOMS}
    return sorted(found, key=lambda one: f"{one.__module__}.{one.__name__}")


def _made(kind: type[BaseException]) -> BaseException:
    if not isinstance(kind.__init__, FunctionType):
        return kind("some words")
    types = get_type_hints(kind.__init__)
    names = list(inspect.signature(kind).parameters)
    return kind(*(ARGUMENTS[types[name]] for name in names))


@pytest.mark.parametrize("kind", _errors(), ids=lambda kind: f"{kind.__module__}.{kind.__name__}")
def test_an_error_keeps_its_type_its_message_and_its_attributes(kind: type[BaseException]) -> None:
    error = _made(kind)
    assert str(error)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is kind
    assert str(again) == str(error)
    assert vars(again) == vars(error)
    assert again.args == error.args


def test_all_errors_are_found() -> None:
    names = {one.__name__ for one in _errors()}
    assert {"InvalidValueError", "MeshUndecidedError", "VersionSkewError", "ProblemError", "ListenError"} <= names
    assert len(names) > 40
