"""Requests made from the service's own description, and whether the answers are as it says (Schemathesis)."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import schemathesis
from fastapi import FastAPI
from schemathesis.config import SchemathesisConfig
from schemathesis.engine import Status, StopReason, events, from_schema
from schemathesis.engine.recorder import ScenarioRecorder

from threadstate.library.grid import Grid

GRID = Grid(tilt_max_deg=3.0, tilt_step_deg=3.0, phase_step_deg=15.0)
"""Of the library that is asked: its poses are known here, so that they are found."""
LONGEST_REQUEST_S = 120
STREAM = r"^/v1/jobs/.*/events$"
EVENTS_READ = 3
LONGEST_STREAM_S = 1
"""A job that nobody works on never ends its stream: after so many events, or so long, it has been heard enough."""
MADE_UP_PER_SLOW = 20
"""An operation that solves, settles or turns each time, or streams, gets one case for so many of the others."""
SLOW = rf"^/v1/histories/|^/v1/settle$|^/v1/assemblies$|{STREAM}"
MADE_UP_PER_SEQUENCE = 3
"""A sequence is of several requests: there is one for so many cases of an operation."""
RULES_BETWEEN_VALUES = r"/(states|transitions|paths|locate|intervals|heights|solve|settle|assemblies|jobs|threads)$"
"""Where a value may be refused for what no schema says: another value beside it, a cursor's content, a name."""


@dataclass
class Tally:
    """What came of a run: each operation's cases and the seconds they took, the statuses, what was wrong, in words."""

    cases: Counter[str] = field(default_factory=Counter)
    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    statuses: Counter[int] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    @property
    def total(self) -> int:
        """How many requests were made."""
        return self.cases.total()


def fuzz(app: FastAPI, key: str, *, examples: int, seed: int, told: Callable[[str, Tally], None]) -> Tally:
    """Ask ``app`` whatever its description allows and forbids, in this process, and check each answer.

    Every check of Schemathesis holds: no failure of the server, status, media type, headers and content as described,
    what the description forbids refused, what it allows not refused as invalid, no write without a key.

    Args:
        app: the service, over a database with a library of :data:`GRID`.
        key: one for writing.
        examples: how many random cases an operation gets, beside those that its description lays out.
        seed: the same seed makes the same cases.
        told: called with the name of each part that is over, and the tally so far.
    """
    schema = schemathesis.openapi.from_asgi(
        "/openapi.json", app, config=SchemathesisConfig.from_dict(_config(key, examples, seed))
    )
    tally = Tally()
    for event in from_schema(schema).execute():
        match event:
            case events.ScenarioFinished():
                _count(tally, event.recorder)
                if event.status is Status.ERROR:
                    tally.wrong.append(f"{event.recorder.label}: the scenario ended with an error")
            case events.PhaseFinished():
                told(event.phase.name.value, tally)
            case events.NonFatalError():
                tally.wrong.append(f"{event.label}: {event.value}")
            case events.FatalError():
                raise event.exception
            case events.EngineFinished() if event.stop_reason is not StopReason.COMPLETED:
                tally.wrong.append(f"ended early: {event.stop_reason}")
            case _:
                pass
    return tally


def _count(tally: Tally, recorder: ScenarioRecorder) -> None:
    for case_id, node in recorder.cases.items():
        interaction = recorder.interactions.get(case_id)
        if interaction is None:
            continue
        tally.cases[node.value.operation.label] += 1
        if interaction.response is not None:
            tally.statuses[interaction.response.status_code] += 1
            tally.seconds[node.value.operation.label] += interaction.response.elapsed
    for case_id, checks in recorder.checks.items():
        label = recorder.cases[case_id].value.operation.label
        for check in checks:
            if check.failure_info is not None:
                tally.wrong.append(f"{label}: {check.failure_info.failure}\n{check.failure_info.code_sample}")
            elif check.status is Status.ERROR:
                tally.wrong.append(f"{label}: the check {check.name} failed itself")


def _config(key: str, examples: int, seed: int) -> dict[str, Any]:
    phases = [index * GRID.phase_step_deg for index in range(GRID.phase_count)]
    tilts = list(GRID.tilts_deg)
    words: dict[str, list[float] | list[str] | list[int]] = {
        "tilts": tilts,
        "phases": phases,
        "libraries": ["latest", "latest-mesh", "1", "1-4-20-unc", "1%2F4-20%20UNC"],
        "jobs": [1, 2, 3],
    }
    return {
        "seed": seed,
        "request-timeout": LONGEST_REQUEST_S,
        "max-stream-events": EVENTS_READ,
        "continue-on-failure": True,
        "headers": {"Authorization": f"Bearer {key}"},
        "dictionaries": {name: {"values": values} for name, values in words.items()},
        "parameters": {
            "path.roll": {"dictionary": "tilts", "probability": 0.8},
            "path.pitch": {"dictionary": "tilts", "probability": 0.8},
            "path.phase": {"dictionary": "phases", "probability": 0.8},
            "path.id": {"dictionary": "libraries", "probability": 0.8},
        },
        "generation": {"max-examples": examples, "deterministic": False, "database": "none"},
        # What is cancelled stays, to be asked for.
        "checks": {"use_after_free": {"enabled": False}, "ensure_resource_availability": {"enabled": False}},
        "phases": {
            "coverage": {"generate-duplicate-query-parameters": True},
            "stateful": {"generation": {"max-examples": max(examples // MADE_UP_PER_SEQUENCE, 1)}},
        },
        "operations": [
            {"include-path-regex": RULES_BETWEEN_VALUES, "checks": {"positive_data_acceptance": {"enabled": False}}},
            {"include-path-regex": SLOW, "generation": {"max-examples": max(examples // MADE_UP_PER_SLOW, 1)}},
            {"include-path-regex": STREAM, "request-timeout": LONGEST_STREAM_S},
            {
                "include-path-regex": "^/v1/jobs/",
                "parameters": {"path.id": {"dictionary": "jobs", "probability": 0.8}},
            },
        ],
    }
