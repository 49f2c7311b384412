"""What a search for a device found, as the command line prints it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from threadstate.device.document import device_document
from threadstate.device.model import Limits
from threadstate.numbers import number_text
from threadstate.success.design import Candidate, Parameter, Tolerance
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import inputs_document
from worker.design.run import DesignResult
from worker.output import print_json, print_line
from worker.tables import table


def print_design_json(inputs: SuccessInputs, limits: Limits, result: DesignResult, elapsed_s: float) -> None:
    """Print what was searched and all that was found as one object."""
    searched = {name: value for name, value in inputs_document(inputs).items() if name not in ("pair", "device")}
    print_json(
        {
            **searched,
            "unit": inputs.pair.unit,
            "limits": {
                "tilt": limits.tilt_deg,
                "shift": limits.shift,
                "torque": limits.torque,
            },
            "vary": [{"name": one.name, "low": one.low, "high": one.high} for one in result.parameters],
            "base": _candidate(result.parameters, result.base),
            "tried": [_candidate(result.parameters, one) for one in result.tried],
            "front": [_candidate(result.parameters, one) for one in result.front],
            "finalists": [_candidate(result.parameters, one) for one in result.finalists],
            "tolerances": [
                {
                    "name": one.name,
                    "value": one.value,
                    "low": one.low,
                    "high": one.high,
                    "fails_below": one.fails_below,
                    "fails_above": one.fails_above,
                }
                for one in result.tolerances
            ],
            "elapsed_s": round(elapsed_s, 3),
        }
    )


def print_design(inputs: SuccessInputs, limits: Limits, result: DesignResult, elapsed_s: float) -> None:
    """Print the finalists beside the device that was begun with, the front, and how far the best one may err."""
    orientations = inputs.grid.orientation_count
    unit = inputs.pair.unit
    words = _words(limits, unit)
    print_line(f"{len(result.tried)} devices tried in {elapsed_s:.0f} s, of {orientations} orientations; {words}")
    print_line("")
    _print_candidates(inputs, "device", result, [("as given", result.base), *_numbered(result.finalists)])
    print_line("")
    _print_candidates(inputs, "front", result, _numbered(result.front))
    print_line("")
    rows = table("varied", "value", "from", "to", "fails below", "fails above")
    for one in result.tolerances:
        rows.add_row(one.name, *(f"{value:.4g}" for value in (one.value, one.low, one.high)), *_failing(one))
    rows.print()


def _print_candidates(
    inputs: SuccessInputs, heading: str, result: DesignResult, named: Sequence[tuple[str, Candidate]]
) -> None:
    unit = inputs.pair.unit
    frictions = named[0][1].frictions
    rows = table(
        heading,
        *(one.name for one in result.parameters),
        *(f"engaged at {number_text(mu)}" for mu in frictions),
        "worst critical",
        f"torque (N {unit})",
        "tilt",
        "shift",
    )
    for name, one in named:
        values = one.values or [device_document(one.device).get(each.name) for each in result.parameters]
        rows.add_row(
            name,
            *(value if isinstance(value, str) else f"{value:.4g}" for value in values),
            *(_count(count, is_open) for count, is_open in zip(one.engaged, one.undecided, strict=True)),
            "none" if one.worst_critical is None else number_text(one.worst_critical),
            *(f"{value:.3g}" for value in (one.torque, one.tilt_deg, one.shift)),
        )
    rows.print()


def _count(engaged: int, undecided: int) -> str:
    return f"{engaged} (+{undecided}?)" if undecided else str(engaged)


def _numbered(candidates: Sequence[Candidate]) -> list[tuple[str, Candidate]]:
    return [(str(k), one) for k, one in enumerate(candidates, 1)]


def _failing(one: Tolerance) -> tuple[str, str]:
    below, above = ("-" if value is None else f"{value:.4g}" for value in (one.fails_below, one.fails_above))
    return below, above


def _words(limits: Limits, unit: str) -> str:
    given = (("tilt", limits.tilt_deg, "deg"), ("shift", limits.shift, unit), ("torque", limits.torque, f"N {unit}"))
    return ", ".join(f"any {name}" if most is None else f"{name} up to {most:.4g} {of}" for name, most, of in given)


def _candidate(parameters: Sequence[Parameter], one: Candidate) -> dict[str, Any]:
    return {
        "values": {parameter.name: value for parameter, value in zip(parameters, one.values, strict=False)},
        "device": device_document(one.device),
        "mu": list(one.frictions),
        "engaged": list(one.engaged),
        "undecided": list(one.undecided),
        "worst_critical": one.worst_critical,
        "mean_critical": one.mean_critical,
        "torque": one.torque,
        "tilt": one.tilt_deg,
        "shift": one.shift,
    }
