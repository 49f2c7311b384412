"""Output of sweeps, as tables or JSON."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.library.identity import LibraryInputs
from worker.output import print_json, print_line
from worker.sweep.estimate import Estimate
from worker.sweep.run import SweepResult
from worker.tables import table

MINUTE_S, HOUR_S, DAY_S = 60.0, 3600.0, 86400.0
DECIMAL_PREFIXES = ("", "k", "M", "G", "T", "P")


def print_estimates(estimates: Sequence[Estimate], *, as_json: bool) -> None:
    """One row a library, and their sum."""
    if as_json:
        for one in estimates:
            print_json(
                {
                    **_named(one.inputs),
                    "state": _state(one),
                    "poses": one.inputs.grid.pose_count,
                    "rows": one.row_count,
                    "bytes": one.bytes,
                    "seconds": round(one.seconds, 1),
                }
            )
        return
    rows = table("pair", "method", "grid", "is", "poses", "rows", "bytes", "time")
    for one in estimates:
        rows.add_row(
            one.inputs.pair.designation,
            one.inputs.method.value,
            _grid(one.inputs),
            _state(one),
            f"{one.inputs.grid.pose_count:,}",
            f"{one.row_count:,}",
            _short(one.bytes),
            _time(one.seconds),
        )
    rows.add_row(
        f"{len(estimates)} libraries",
        "",
        "",
        "",
        f"{sum(one.inputs.grid.pose_count for one in estimates):,}",
        f"{sum(one.row_count for one in estimates):,}",
        _short(sum(one.bytes for one in estimates)),
        _time(sum(one.seconds for one in estimates)),
    )
    rows.print()


def print_sweep_result(one: SweepResult, *, as_json: bool) -> None:
    """A line for a library."""
    if as_json:
        numbers = {"library": one.library_id, "content_sha256": one.content_sha256, "job": one.job_id}
        print_json({**_named(one.inputs), "outcome": one.outcome.value, **numbers, "reason": one.reason})
        return
    details = {
        "library": one.library_id,
        "content": one.content_sha256 and one.content_sha256[:12],
        "job": one.job_id,
    }
    values = ", ".join(f"{name} {value}" for name, value in details.items() if value is not None) or one.reason
    print_line(
        f"{one.outcome.value}: {one.inputs.pair.designation}, {one.inputs.method.value}, {_grid(one.inputs)}: {values}"
    )


def _named(inputs: LibraryInputs) -> dict[str, object]:
    grid = inputs.grid
    return {
        "pair": inputs.pair.designation,
        "method": inputs.method.value,
        "tilt_max": grid.tilt_max_deg,
        "tilt_step": grid.tilt_step_deg,
        "phase_step": grid.phase_step_deg,
        "input_sha256": inputs.sha256,
    }


def _grid(inputs: LibraryInputs) -> str:
    return str(inputs.grid)


def _state(one: Estimate) -> str:
    if one.published:
        return "there"
    return f"{one.committed}/{one.inputs.grid.orientation_count}" if one.committed else "new"


def _short(count: float) -> str:
    """A number of bytes with a decimal prefix."""
    prefixes = iter(DECIMAL_PREFIXES)
    prefix = next(prefixes)
    while count >= 1000.0:
        count, prefix = count / 1000.0, next(prefixes)
    return f"{count:.3g} {prefix}B"


def _time(seconds: float) -> str:
    for unit_s, unit in ((DAY_S, "d"), (HOUR_S, "h"), (MINUTE_S, "min")):
        if seconds >= unit_s:
            return f"{seconds / unit_s:.1f} {unit}"
    return f"{seconds:.1f} s"
