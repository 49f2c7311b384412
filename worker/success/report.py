"""A success map as the command line prints it."""

from __future__ import annotations

import math

from threadstate.numbers import number_text
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import inputs_document
from threadstate.success.model import CriticalFriction, OrientationMap
from threadstate.success.scaled import scaled_orientation
from threadstate.success.summary import late_snaps, map_counts, orientation_summary, tilt_area
from threadstate.success.summary_document import summarised_document, totals_documents
from threadstate.units import LengthUnit, conversion_factor
from worker.output import print_json, print_line
from worker.success.run import SuccessResult
from worker.tables import table


def print_map_json(inputs: SuccessInputs, result: SuccessResult, elapsed_s: float, unit: LengthUnit) -> None:
    """Print inputs, hashes, summaries and all orientations as one object; what paths ask for is in ``unit``."""
    orientations = _in_unit(inputs, result, unit)
    print_json(
        {
            **inputs_document(inputs),
            "content_sha256": result.content_sha256,
            "unit": unit,
            "computed": result.computed,
            "elapsed_s": round(elapsed_s, 3),
            "summary": totals_documents(orientations, inputs),
            "orientations": [summarised_document(one, inputs.grid, inputs.frictions) for one in orientations],
        }
    )


def print_map(inputs: SuccessInputs, result: SuccessResult, elapsed_s: float, unit: LengthUnit) -> None:
    """Print how many orientations engage at each friction, and each orientation; lengths in ``unit``."""
    orientations = _in_unit(inputs, result, unit)
    totals = table("mu", "orientations", "engaged", "around level", "largest", "outcomes", words_last=True)
    for mu in inputs.frictions:
        area = tilt_area(orientations, inputs.grid, mu)
        counts = map_counts(orientations, inputs.grid, mu)
        outcomes = [f"{count} {outcome.value}" for outcome, count in counts.outcomes]
        flags = [f"{count} {flag}" for flag, count in counts.flags]
        bounded = [f"{counts.bounded} bounded"] if counts.bounded else []
        words = ", ".join([*outcomes, *bounded, *flags])
        numbers = (area.orientations, area.engaged, area.around_level, area.largest)
        totals.add_row(number_text(mu), *map(str, numbers), words)
    totals.print()
    for mu in inputs.frictions:
        late = late_snaps(orientations, inputs, mu)
        if late.turn_deg is not None:
            print_line(
                f"mu {number_text(mu)}: {late.paths} {'path ends' if late.paths == 1 else 'paths end'} before a snap "
                f"that others of the orientation meet; a ccw_turn of {math.ceil(late.turn_deg)} deg reaches it"
            )
    print_line("")
    rows = table(
        "roll",
        "pitch",
        "critical friction",
        "mu",
        "share",
        "worst phase",
        f"torque (N {unit})",
        "tilt",
        f"shift ({unit})",
    )
    for one in orientations:
        for mu in inputs.frictions:
            summary = orientation_summary(one, inputs.grid, mu)
            rows.add_row(
                number_text(one.roll_deg),
                number_text(one.pitch_deg),
                critical_text(one.critical),
                number_text(mu),
                f"{summary.engaged}/{summary.phases}",
                number_text(summary.worst_phase_deg),
                *("-" if value is None else f"{value:.3g}" for value in (summary.torque, summary.tilt_deg)),
                "-" if summary.shift is None else f"{summary.shift:.3g}",
            )
    rows.print()
    print_line("")
    kept = len(result.orientations) - result.computed
    print_line(
        f"content {result.content_sha256[:12]}: {result.computed} orientations computed in {elapsed_s:.1f} s"
        + (f", {kept} read from the file" if kept else "")
    )


def critical_text(critical: CriticalFriction) -> str:
    """The interval of a critical friction in words; an undecided end is marked."""
    if critical.first is None:
        return f">= {critical.last:.4g}"
    last = "none" if critical.last is None else f"{critical.last:.4g}"
    assert critical.outcome is not None
    return f"{last} to {critical.first:.4g} ({critical.outcome.value})"


def _in_unit(inputs: SuccessInputs, result: SuccessResult, unit: LengthUnit) -> list[OrientationMap]:
    factor = conversion_factor(inputs.pair.unit, unit)
    return [scaled_orientation(one, factor) for one in result.orientations]
