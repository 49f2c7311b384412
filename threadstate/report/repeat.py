"""How a report is made again: files of its pair and device, and the command."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator, Mapping
from typing import Any

from threadstate.device.document import device_document
from threadstate.device.model import Device, default_device
from threadstate.numbers import number_text
from threadstate.report.contents import ChosenPath, Report
from threadstate.thread.catalogue import is_known, pair_by_designation
from threadstate.thread.pair import Pair

PAIR_FILE, DEVICE_FILE, MAP_FILE, OUT_FILE = "pair.toml", "device.toml", "device.map", "report.html"


def is_default(device: Device) -> bool:
    """Whether a device is the default one."""
    return device_document(device) == device_document(default_device())


def is_in_catalogue(pair: Pair) -> bool:
    """Whether a pair is the one that its designation names."""
    return is_known(pair.designation) and pair_by_designation(pair.designation) == pair


def device_toml(device: Device) -> str:
    """A device as a file."""
    return "".join(_toml(device_document(device)))


def pair_toml(report: Report) -> str:
    """The report's pair as a file."""
    return "".join(_toml(json.loads(report.inputs.pair_json)))


def command(report: Report) -> str:
    """The command that writes the report, an option or two a line."""
    inputs, chosen = report.inputs, report.chosen
    grid = inputs.grid
    pair = inputs.pair.designation if is_in_catalogue(inputs.pair) else PAIR_FILE
    lines = [
        ["threadstate", "report", "--out", OUT_FILE, "--map", MAP_FILE],
        ["--pair", pair, *([] if is_default(inputs.device) else ["--device", DEVICE_FILE])],
        ["--strategy", inputs.strategy.value, "--mu", ",".join(map(number_text, inputs.frictions))],
        ["--phases", str(grid.phase_count)],
        ["--tilt-max", number_text(grid.tilt_max_deg), "--tilt-step", number_text(grid.tilt_step_deg)],
        ["--phase-tolerance", number_text(inputs.phase_tolerance_deg)],
        ["--mu-tolerance", number_text(inputs.mu_tolerance), "--point-limit", str(inputs.point_limit)],
        *([] if chosen.is_default else _pose(chosen)),
        ["--unit", report.unit.value, "--date", report.date.isoformat(), "--title", report.title],
    ]
    return " \\\n  ".join(shlex.join(line) for line in lines)


def _pose(chosen: ChosenPath) -> list[list[str]]:
    return [
        ["--roll", number_text(chosen.roll_deg), "--pitch", number_text(chosen.pitch_deg)],
        ["--phase", number_text(chosen.phase_deg), "--path-mu", number_text(chosen.mu)],
    ]


def _toml(values: Mapping[str, Any]) -> Iterator[str]:
    """Values as lines of TOML, tables last."""
    for name, value in values.items():
        if not isinstance(value, Mapping):
            yield f"{name} = {_value(value)}\n"
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield f"\n[{name}]\n"
            yield from _toml(value)


def _value(value: Any) -> str:
    if isinstance(value, str):
        # JSON leaves DEL as it is; TOML does not.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return number_text(value)
