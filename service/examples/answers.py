"""The examples of the interface's description: which answer to which operation."""

from __future__ import annotations

from dataclasses import dataclass

from service.examples.states import SOLVED_STATE, STATE
from service.histories.columns import csv_table, history_columns
from threadstate.thread.catalogue import DEFAULT_DESIGNATION

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
_COLUMNS = history_columns([STATE])

EXAMPLES = (
    Example(
        _STATES, "get", _JSON, "page", "The last page", {"library": 1, "unit": "in", "states": [STATE], "next": None}
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
    Example(
        "/v1/solve",
        "post",
        _JSON,
        "solved",
        "Three contacts, one after another",
        {"designation": DEFAULT_DESIGNATION, "library": None, "unit": "in", "states": [SOLVED_STATE]},
    ),
)
