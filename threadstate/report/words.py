"""Numbers and sentences of a report, as plain text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from decimal import Decimal

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.numbers import number_text
from threadstate.report.contents import FrictionPart, Report
from threadstate.success.model import CriticalFriction, OrientationMap

MINUS = "\N{MINUS SIGN}"
NOTHING = "\N{EN DASH}"
DIGITS = 4
"""Significant digits of what is measured; angles and frictions of the grid have all of theirs."""

LEAST_WITHOUT_EXPONENT = 1e-7

NEWTON = "N\N{NO-BREAK SPACE}"
"""Before a unit of length, from which no line breaks it off: a torque or an energy."""

FAILURES = {
    AssemblyOutcome.ENGAGED: "engages",
    AssemblyOutcome.CROSS_THREADED: "cross-threads",
    AssemblyOutcome.JAMMED: "jams",
    AssemblyOutcome.NO_SNAP: "does not snap in",
    AssemblyOutcome.IDLE: "turns idly, without following the thread",
    AssemblyOutcome.SLIPPED: "slips off the nut",
    AssemblyOutcome.OVER_TRAVEL: "asks for more travel than the device has",
    AssemblyOutcome.UNDECIDED: "has no certain outcome",
}


def turning(strategy: Strategy, device: Device) -> str:
    """What a hand does by a strategy."""
    if strategy is Strategy.CW:
        return "turns clockwise through 270 deg at once"
    farthest = exact(device.ccw_turn_deg)
    return f"turns counter-clockwise until the bolt snaps in, or through {farthest} deg, then clockwise through 270 deg"


def exact(value: float) -> str:
    """A number with all its digits and a minus sign, as of a grid."""
    return number_text(value).replace("-", MINUS)


def rounded(value: float | None, digits: int = DIGITS) -> str:
    """A number of some significant digits, without an exponent unless it is tiny; a dash where there is none."""
    if value is None:
        return NOTHING
    shortest = number_text(float(f"{value:.{digits}g}"))
    text = format(Decimal(shortest), "f") if abs(value) >= LEAST_WITHOUT_EXPONENT else shortest
    return text.replace("-", MINUS)


def name_of(word: str) -> str:
    """A name of the interface as words: no_snap is "no snap"."""
    return word.replace("_", " ")


def listed(texts: Sequence[str]) -> str:
    """Texts with commas, "and" before the last one."""
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} and {texts[-1]}"


def counted(count: int, one: str, many: str | None = None) -> str:
    """A number of things."""
    return f"{count:,} {one if count == 1 else many or f'{one}s'}"


def pose_words(one: OrientationMap) -> str:
    """An orientation in words."""
    return f"roll {exact(one.roll_deg)}°, pitch {exact(one.pitch_deg)}°"


def critical_words(critical: CriticalFriction) -> str:
    """The critical friction of an orientation, short."""
    if critical.first is None:
        return f"at least {exact(critical.last or 0.0)}"
    why = name_of(str(critical.outcome))
    if critical.last is None:
        return f"none ({why} without friction)"
    return f"{rounded(critical.last)} to {rounded(critical.first)} ({why})"


def answer(report: Report) -> Iterator[str]:
    """The answer, a sentence or two a paragraph."""
    yield _engaging(report)
    if failing := _failing(report):
        yield failing
    yield _needs(report)
    yield _undecided(report)


def _engaging(report: Report) -> str:
    """How many orientations engage."""
    grid = report.inputs.grid
    counts = [f"{part.area.engaged} {friction_words(part.mu)}" for part in report.parts]
    if report.parts[0].mu > 0.0:
        counts.insert(0, f"{len(report.without_friction)} without friction")
    few = {1: "the one starting phase", 2: "both starting phases"}
    phases = few.get(grid.phase_count, f"all {grid.phase_count} starting phases")
    return (
        f"Of {counted(len(report.orientations), 'orientation')}, roll and pitch up to {exact(grid.tilt_max_deg)}°, "
        f"the bolt engages from {phases} in {listed(counts)}."
    )


def _failing(report: Report) -> str:
    """Which orientations fail, and which first; nothing where all are undecided without friction."""
    sentences = []
    failing = report.failing_without_friction
    if failing:
        outcomes = {one.critical.outcome for one in failing}
        kinds = [FAILURES[outcome] for outcome in AssemblyOutcome if outcome in outcomes]
        nearest = failing[0]
        count = counted(len(failing), "orientation fails", "orientations fail")
        sentences.append(
            f"{count} even without friction: the bolt {' or '.join(kinds)}; the nearest to level is "
            f"{pose_words(nearest)}."
        )
    first = report.first_failure
    if first is not None:
        critical = first.critical
        assert critical.first is not None and critical.phase_deg is not None and critical.outcome is not None
        sentences.append(
            f"As friction grows, the first certain failure is at {pose_words(first)}: it engages "
            f"{upto_words(critical.last)}; at μ = {rounded(critical.first)} the bolt {FAILURES[critical.outcome]}, "
            f"from phase {rounded(critical.phase_deg, 6)}°."
        )
    elif report.inputs.frictions[-1] == 0.0:
        sentences.append("What friction changes was not computed.")
    elif report.without_friction:
        largest = exact(report.inputs.frictions[-1])
        sentences.append(
            f"No orientation that engages without friction is known to fail up to μ = {largest}, the largest of this "
            "map."
        )
    return " ".join(sentences)


def _needs(report: Report) -> str:
    """What the paths that engage ask for."""
    most = [
        f"{friction_words(part.mu)}, {rounded(part.torque, 3)} {NEWTON}{report.unit} of torque, "
        f"{rounded(part.tilt_deg, 3)}° of tilt and {rounded(part.shift, 3)} {report.unit} of shift"
        for part in report.parts
        if part.engaged_paths
    ]
    if not most:
        return "No path of the map engages, so nothing can be said of what assembly asks of the device."
    return f"The paths that engage ask of the device, at most: {'; '.join(most)}."


def _undecided(report: Report) -> str:
    """What is not known, and why."""
    unsure = [part for part in report.parts if part.undecided_paths]
    if not unsure:
        return "Every path of the map has a certain outcome."
    texts = [
        f"{part.undecided_paths} of {part.paths} paths {friction_words(part.mu)} ({reasons(part)})" for part in unsure
    ]
    return f"Undecided: {listed(texts)}. Such a path may engage or not; its orientation is not counted as engaging."


def friction_words(mu: float) -> str:
    """At which friction."""
    return f"at μ = {exact(mu)}" if mu else "without friction"


def upto_words(mu: float | None) -> str:
    """Up to which friction."""
    return f"up to μ = {rounded(mu)}" if mu else "without friction"


def reasons(part: FrictionPart) -> str:
    """Why paths of a friction are undecided."""
    texts = [f"{count} {name_of(reason)}" for reason, count in part.reasons]
    return ", ".join(texts) or NOTHING
