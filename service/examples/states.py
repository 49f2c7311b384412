"""Two real states; ``make docs`` computes them anew, a test compares."""

from __future__ import annotations

import json
from pathlib import Path

from threadstate.state.document import StateDocument


def _state(name: str) -> StateDocument:
    document: StateDocument = json.loads(Path(__file__).with_name(name).read_text())
    return document


STATE = _state("state.json")
"""The state of a pose of a library's grid, which comes to lie flush; lengths in inches."""
SOLVED_STATE = _state("solved_state.json")
"""The state of a pose between those of a grid, three contacts one after another; lengths in inches."""
