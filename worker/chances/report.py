"""What sampled paths say, as the command line prints it."""

from __future__ import annotations

from threadstate.chances.inputs import ChancesInputs
from threadstate.chances.model import Record
from threadstate.chances.network import ChancesNetwork, FormationNode, network_of
from threadstate.chances.network_document import chances_document, target_text, watch_document
from threadstate.chances.proportion import Chance, Interval
from threadstate.chances.record_file import inputs_document
from threadstate.chances.scaled import scaled_record
from threadstate.chances.watch import Located, Observation, located
from threadstate.units import LengthUnit, conversion_factor
from worker.chances.run import ChancesResult
from worker.output import print_json, print_line
from worker.tables import table

MOST_ROWS = 20
"""Of a table of formations or moves; JSON has all."""


def print_chances_json(
    inputs: ChancesInputs,
    result: ChancesResult,
    observation: Observation | None,
    elapsed_s: float,
    unit: LengthUnit,
) -> None:
    """Print inputs, hashes, the network and what the observation says as one object; torques in N times ``unit``."""
    records = _in_unit(inputs, result, unit)
    print_json(
        {
            **inputs_document(inputs),
            "content_sha256": result.content_sha256,
            "unit": unit,
            "samples": len(records),
            "computed": result.computed,
            "elapsed_s": round(elapsed_s, 3),
            **chances_document(network_of(records)),
            "watch": None if observation is None else watch_document(located(records, observation)),
        }
    )


def print_chances(
    inputs: ChancesInputs,
    result: ChancesResult,
    observation: Observation | None,
    elapsed_s: float,
    unit: LengthUnit,
) -> None:
    """Print outcomes, what the paths tell, and the moves; torques in N times ``unit``."""
    records = _in_unit(inputs, result, unit)
    network = network_of(records)
    _print_outcomes(network)
    _print_formations(network, unit)
    _print_moves(network)
    if observation is not None:
        _print_watch(located(records, observation))
    kept = len(records) - result.computed
    print_line(
        f"content {result.content_sha256[:12]}: {result.computed} samples computed in {elapsed_s:.1f} s"
        + (f", {kept} read from the file" if kept else "")
    )


def _print_outcomes(network: ChancesNetwork) -> None:
    rows = table("outcome", "paths", "share", "interval")
    for outcome, ends in network.outcomes:
        rows.add_row(outcome.value, f"{ends.count}/{ends.of}", _percent(ends.share), _interval_text(ends.interval))
    rows.print()
    bounds = network.chance.bounds
    sentence = f"engaged: {_percent(bounds.low)}"
    if network.chance.undecided:
        sentence += f" if all undecided paths fail, {_percent(bounds.high)} if all engage"
    print_line(f"{sentence}; interval {_interval_text(network.chance.interval)}")
    if network.bounded:
        print_line(f"{network.bounded} bounded")
    if network.turning is None:
        print_line("no path engages: nothing is known of the turning to assembly")
    else:
        q10, median, q90 = network.turning.quantiles_deg
        print_line(
            f"turning to assembly: mean {network.turning.mean_deg:.1f} deg; "
            f"of 10, 50 and 90 % at most {q10:.1f}, {median:.1f} and {q90:.1f} deg"
        )
    print_line("")


def _print_formations(network: ChancesNetwork, unit: LengthUnit) -> None:
    rows = table(
        "difference",
        "engaged",
        "interval",
        "paths",
        "reached",
        "turned",
        f"torque (N {unit})",
        "formation",
        words_last=True,
    )
    for node in network.telling[:MOST_ROWS]:
        assert node.difference is not None
        rows.add_row(
            f"{100.0 * node.difference:+.1f} %" + (" *" if node.is_distinct else ""),
            _chance_text(node.chance),
            _interval_text(node.chance.interval),
            f"{node.visited.count}/{node.visited.of}",
            f"{node.reached_deg:.1f}",
            f"{node.turned_deg:.1f}",
            f"{node.torque[0]:.3g} to {node.torque[1]:.3g}",
            f"{node.formation} ({_force_text(node)})",
        )
    rows.print()
    _print_left_out(len(network.nodes), min(len(network.telling), MOST_ROWS), "formations")
    print_line("")


def _print_moves(network: ChancesNetwork) -> None:
    rows = table("moves", "probability", "left", "from", "to", words_last=True)
    ranked = sorted(network.edges, key=lambda edge: -edge.moves.count)
    for edge in ranked[:MOST_ROWS]:
        moves = edge.moves
        ways = (str(edge.source), target_text(edge.target))
        rows.add_row(f"{moves.count}/{moves.of}", _percent(moves.share), edge.left.value, *ways)
    rows.print()
    _print_left_out(len(ranked), min(len(ranked), MOST_ROWS), "moves")
    print_line("")


def _print_watch(found: Located) -> None:
    print_line(
        f"observed: {found.matching} of {found.points} points, "
        f"{found.chance.of} paths, engaged {_chance_text(found.chance)} "
        f"({_interval_text(found.chance.interval)})"
    )
    rows = table("share", "points", "engaged", "interval", "formation", words_last=True)
    for one in found.remaining:
        interval = _interval_text(one.chance.interval)
        rows.add_row(_percent(one.share), str(one.points), _chance_text(one.chance), interval, str(one.formation))
    rows.print()
    print_line("")


def _print_left_out(count: int, shown: int, name: str) -> None:
    if count > shown:
        print_line(f"{count - shown} more {name} with --json")


def _chance_text(chance: Chance) -> str:
    undecided = f" + {chance.undecided} undecided" if chance.undecided else ""
    return f"{chance.engaged}/{chance.of}{undecided}"


def _force_text(node: FormationNode) -> str:
    axes = zip("xyz", node.force_low, node.force_high, strict=True)
    return ", ".join(f"F{axis} {low:.3g} to {high:.3g} N" for axis, low, high in axes)


def _interval_text(interval: Interval) -> str:
    return f"{100.0 * interval.low:.1f} to {100.0 * interval.high:.1f} %"


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _in_unit(inputs: ChancesInputs, result: ChancesResult, unit: LengthUnit) -> list[Record]:
    factor = conversion_factor(inputs.pair.unit, unit)
    return [scaled_record(record, factor) for record in result.records]
