"""The examples of the OpenAPI document. Two real states, real statics, a real settled state and a real path; ``make
docs`` computes them again, a test compares.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from service.histories.endpoints import csv_table, history_columns
from threadstate.device.assembly_document import AssemblyDocument
from threadstate.device.document import SettledDocument
from threadstate.state.document import StateDocument
from threadstate.statics.document import StaticsDocument
from threadstate.statics.stored import LibraryStateDocument
from threadstate.thread.catalogue import DEFAULT_DESIGNATION
from threadstate.thread.standards.sizes import UNIFIED_SOURCE


def _document(name: str) -> Any:
    return json.loads(Path(__file__).with_name(name).read_text())


LIBRARY_STATE: LibraryStateDocument = _document("state.json")
"""The state of a pose of a library's grid, which comes to lie flush; lengths in inches."""
STATE = {name: value for name, value in LIBRARY_STATE.items() if name != "statics"}
"""The same without its statics."""
SOLVED_STATE: StateDocument = _document("solved_state.json")
"""The state of a pose between those of a grid, three contacts one after another; lengths in inches."""
STATICS: StaticsDocument = _document("statics.json")
"""What a force does to the state of a pose of a library's grid, three contacts that hold it; lengths in inches."""
SETTLED_POSE: SettledDocument = _document("settled_pose.json")
"""Where a bolt comes to rest that the default device holds, on two contacts; lengths in inches."""
ASSEMBLY: AssemblyDocument = _document("assembly.json")
"""How a bolt engages that the default device turns clockwise, the first and the last point; lengths in inches."""

_JSON = "application/json"


@dataclass(frozen=True)
class Example:
    """A successful answer: to which operation, of which media type, and what it shows."""

    path: str
    method: str
    media_type: str
    name: str
    summary: str
    value: object


_STATES = "/v1/libraries/{id}/states"
_HISTORY = "/v1/libraries/{id}/histories/{roll}/{pitch}"
_ORIENTATION = {"library": 1, "unit": "in", "roll": STATE["roll"], "pitch": STATE["pitch"]}
_COLUMNS = history_columns([LIBRARY_STATE])

EXAMPLES = (
    Example(
        _STATES,
        "get",
        _JSON,
        "page",
        "The last page",
        {"library": 1, "unit": "in", "states": [LIBRARY_STATE], "next": None},
    ),
    Example(_STATES + "/{roll}/{pitch}/{phase}", "get", _JSON, "flush", "The bolt comes to lie flush", STATE),
    Example(
        _HISTORY,
        "get",
        _JSON,
        "rows",
        "Rows, cut off after the first state",
        {**_ORIENTATION, "states": [STATE], "undecided": []},
    ),
    Example(
        _HISTORY,
        "get",
        _JSON,
        "columns",
        "Columns, cut off after the first state",
        {**_ORIENTATION, "columns": {name: list(cells) for name, cells in _COLUMNS.items()}, "undecided": []},
    ),
    Example(_HISTORY, "get", "text/csv", "csv", "A table, cut off after the first state", csv_table(_COLUMNS).decode()),
    Example(_STATES + "/{roll}/{pitch}/{phase}/statics", "get", _JSON, "held", "Three contacts hold the load", STATICS),
    Example(
        "/v1/statics",
        "post",
        _JSON,
        "held",
        "One pose under one load",
        {
            "designation": DEFAULT_DESIGNATION,
            "source": UNIFIED_SOURCE,
            "library": None,
            "unit": "in",
            "statics": [STATICS],
        },
    ),
    Example(
        "/v1/solve",
        "post",
        _JSON,
        "solved",
        "Three contacts, one after another",
        {
            "designation": DEFAULT_DESIGNATION,
            "source": UNIFIED_SOURCE,
            "library": None,
            "unit": "in",
            "states": [SOLVED_STATE],
        },
    ),
    Example(
        "/v1/settle",
        "post",
        _JSON,
        "settled",
        "Two contacts, and the springs",
        {
            "designation": DEFAULT_DESIGNATION,
            "source": UNIFIED_SOURCE,
            "library": None,
            "unit": "in",
            "states": [SETTLED_POSE],
        },
    ),
    Example(
        "/v1/assemblies",
        "post",
        _JSON,
        "engaged",
        "The bolt engages; of the points the first and the last",
        ASSEMBLY,
    ),
    Example(
        "/v1/settled/{id}/states/{roll}/{pitch}/{phase}",
        "get",
        _JSON,
        "settled",
        "Two contacts, and the springs",
        SETTLED_POSE,
    ),
)
