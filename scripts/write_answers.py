"""Computes the example responses of the documentation and inserts them: ``make docs``.

Those are the JSON after every ``curl`` of a state, of its statics, of a settled state or of a path, in ``DOCUMENTS``,
and the examples of the HTTP interface.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_document import assembly_document
from threadstate.device.document import SettledDocument, settled_document
from threadstate.device.settle import settle_pose
from threadstate.device.strategy import Strategy
from threadstate.numbers import three_numbers
from threadstate.state.document import StateDocument, state_document
from threadstate.state.solve import solve_pose
from threadstate.statics.document import StaticsDocument, statics_document
from threadstate.statics.load import Load, Vector
from threadstate.statics.rows import stored_statics
from threadstate.statics.solve import statics_of
from threadstate.statics.stored import library_state_document
from threadstate.thread.catalogue import quarter_twenty_unc

ROOT = Path(__file__).parent.parent
DOCUMENTS = ("docs/api.md",)
SHOWN = re.compile(
    r"(?P<query>curl 127\.0\.0\.1:8000/v1/libraries/latest/states/"
    r"(?P<roll>[^/\s]+)/(?P<pitch>[^/\s]+)/(?P<phase>[^/\s]+)\n```.*?```json\n).*?(?P<end>\n```)",
    re.DOTALL,
)
SHOWN_STATICS = re.compile(
    r"(?P<query>curl '127\.0\.0\.1:8000/v1/libraries/latest/states/"
    r"(?P<roll>[^/\s]+)/(?P<pitch>[^/\s]+)/(?P<phase>[^/\s]+)/statics\?mu=(?P<mu>[^&]+)&force=(?P<force>[^&']+)'\n"
    r"```.*?```json\n).*?(?P<end>\n```)",
    re.DOTALL,
)
SHOWN_SETTLED = re.compile(
    r"(?P<query>curl 127\.0\.0\.1:8000/v1/settle --json '[^']*"
    r'"roll": (?P<roll>[^,]+), "pitch": (?P<pitch>[^,]+), "phase": (?P<phase>[^}]+)}]}'
    r"'\n```.*?```json\n).*?(?P<end>\n```)",
    re.DOTALL,
)
SHOWN_PATH = re.compile(
    r"(?P<query>curl 127\.0\.0\.1:8000/v1/assemblies --json '[^']*'\n```.*?```json\n).*?(?P<end>\n```)", re.DOTALL
)
PAIR = quarter_twenty_unc()
EXAMPLES = Path("service/examples")
LIBRARY_POSE_DEG, SOLVED_POSE_DEG = (4.0, -3.0, 185.0), (1.0, -2.0, 10.5)
"""The poses (roll, pitch, phase) of the examples of the HTTP interface."""
LOADED_POSE_DEG, FORCE, FRICTION = (2.0, 0.0, 345.0), (0.1, 0.0, -10.0), 0.25
"""The pose, the force and the friction of its example of statics."""
HELD_POSE_DEG = (0.0, 3.0, 250.0)
"""The pose of its example of settled states, held by the default device."""
TURNED_POSE_DEG = (1.0, -2.0, 10.0)
"""The pose of its example of paths, from which the default device turns clockwise at once."""


def main() -> None:
    """Write all answers."""
    for name in DOCUMENTS:
        path = ROOT / name
        text = SHOWN_STATICS.sub(_statics_shown_again, SHOWN.sub(_shown_again, path.read_text()))
        text = SHOWN_SETTLED.sub(_settled_shown_again, text)
        path.write_text(SHOWN_PATH.sub(_path_shown_again, text))
    stored = solve_pose(PAIR, *LIBRARY_POSE_DEG)
    (statics,) = stored_statics(PAIR, [stored])
    for name, document in (
        ("state.json", library_state_document(stored, statics)),
        ("solved_state.json", _document(*SOLVED_POSE_DEG)),
        ("statics.json", _statics(LOADED_POSE_DEG, FORCE, FRICTION)),
        ("settled_pose.json", _settled(HELD_POSE_DEG)),
        ("assembly.json", turned_path()),
    ):
        (ROOT / EXAMPLES / name).write_text(_broken_into_lines(document) + "\n")


def _shown_again(shown: re.Match[str]) -> str:
    document = _document(float(shown["roll"]), float(shown["pitch"]), float(shown["phase"]))
    return shown["query"] + _broken_into_lines(document) + shown["end"]


def _statics_shown_again(shown: re.Match[str]) -> str:
    roll, pitch, phase = (float(shown[name]) for name in ("roll", "pitch", "phase"))
    document = _statics((roll, pitch, phase), three_numbers("force", shown["force"]), float(shown["mu"]))
    return shown["query"] + _broken_into_lines(document) + shown["end"]


def _settled_shown_again(shown: re.Match[str]) -> str:
    document = _settled((float(shown["roll"]), float(shown["pitch"]), float(shown["phase"])))
    return shown["query"] + _broken_into_lines(document) + shown["end"]


def _path_shown_again(shown: re.Match[str]) -> str:
    return shown["query"] + _broken_into_lines(turned_path()) + shown["end"]


def _settled(pose_deg: Vector) -> SettledDocument:
    return settled_document(settle_pose(PAIR, *pose_deg), PAIR.unit)


def turned_path() -> dict[str, Any]:
    """The example of paths, of whose points the first and the last are left."""
    document = assembly_document(assemble_pose(PAIR, *TURNED_POSE_DEG, strategy=Strategy.CW), PAIR.unit)
    columns = {name: [column[0], column[-1]] for name, column in document["path"].items()}  # type: ignore[index]
    return {**document, "path": columns}


def _statics(pose_deg: Vector, force: Vector, mu: float) -> StaticsDocument:
    return statics_document(statics_of(PAIR, solve_pose(PAIR, *pose_deg), Load(force), mu))


def _document(roll_deg: float, pitch_deg: float, phase_deg: float) -> StateDocument:
    return state_document(solve_pose(PAIR, roll_deg, pitch_deg, phase_deg))


def _broken_into_lines(document: Mapping[str, object]) -> str:
    """The document as JSON with a line for each field, and for each pose, contact and force in it."""
    lines = []
    for name, value in document.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            items = ",\n".join(f"    {json.dumps(item)}" for item in value)
            lines.append(f'  "{name}": [\n{items}\n  ]')
        else:
            lines.append(f'  "{name}": {json.dumps(value)}')
    return "{\n" + ",\n".join(lines) + "\n}"


if __name__ == "__main__":
    main()
