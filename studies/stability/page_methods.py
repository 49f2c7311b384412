"""What the page says of the grid, of the meshes' descents over it, and of all methods beside each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from harness.markdown import table
from studies.stability.agreement import Outcome
from studies.stability.demonstrations import in_words
from studies.stability.descent_study import FINER, OutcomeRow
from studies.stability.findings import Findings
from studies.stability.rival_study import RivalTally
from studies.stability.trials import DECADES
from threadstate.mesh.options import Descent
from threadstate.mesh.segments import Intersection
from threadstate.state.model import ContactState, StateClass


def grid_text(found: Findings) -> str:
    """Classes, and how near events are."""
    poses = [pose for row in found.rows for pose in row.poses]
    classes = Counter(pose.state_class for pose in poses)
    events = Counter(pose.event_decade for pose in poses)
    named = ", ".join(f"{classes[one]:,} {one.value.replace('_', ' ')}" for one in StateClass)
    near = ", ".join(
        f"{count:,} within 1e{decade} deg"
        for decade, count in sorted((d, c) for d, c in events.items() if d is not None)
    )
    refused = sum(row.refused for row in found.rows)
    return (
        f"Of {len(poses):,} poses {named}, {classes[None]:,} refused. Each was changed in one direction by 1e-12, "
        f"1e-9, 1e-6 and 1e-3 deg; {refused:,} of these neighbours were refused. The contacts change: "
        f"{near or 'nowhere'}. In each map a row is an orientation; within a band of one roll, pitch grows downwards."
    )


def descents_text(found: Findings) -> str:
    """How many heights each descent gets wrong, and by how much."""
    lines = []
    for number, method in enumerate(found.extent.descents):
        rows = found.descents
        counts = Counter(one for row in rows for one in row.outcomes(number))
        off = sorted(_errors(found, number))
        rechecks = [one for one in found.rechecks if one.wrong.method == method]
        low = sum(one.wrong.height < one.wrong.exact for one in rechecks)
        lines.append(
            (
                method.name,
                f"{sum(counts.values()):,}",
                f"{counts[Outcome.RIGHT]:,}",
                f"{counts[Outcome.REFUSED]:,}",
                f"{counts[Outcome.HEIGHT]:,}",
                f"{low:,} / {len(rechecks) - low:,}",
                f"{sum(one.beside_event for one in rechecks):,}",
                f"{sum(one.finer is Outcome.HEIGHT for one in rechecks):,}",
                f"{rows[0].errors[number]:.2g}",
                f"{off[len(off) // 2]:.1g}",
                f"{off[-1]:.2g}",
            )
        )
    head = ("descent", "poses", "right", "refused", "wrong", "too low / too high", "beside a jump")
    errors = ("declared error (in)", "median error (in)", "largest error (in)")
    return table((*head, f"wrong by {FINER} meshes as well", *errors), lines)


def _errors(found: Findings, number: int) -> Iterator[float]:
    """How far each height in which a descent ends is from the exact one."""
    for row in found.descents:
        for height, exact in zip(row.heights[number], row.exact, strict=True):
            if height.height is not None and exact is not None:
                yield abs(height.height - exact)


def refusals_text(found: Findings) -> str:
    """Why descents refuse."""
    reasons = Counter(
        (method.name, height.reason)
        for number, method in enumerate(found.extent.descents)
        for row in found.descents
        for height in row.heights[number]
        if height.height is None
    )
    if not reasons:
        return "No descent is refused."
    return "Refused: " + "; ".join(f"{count:,} by {name}: {reason}" for (name, reason), count in reasons.items()) + "."


def descents_csv(found: Findings) -> str:
    """Every pose that a descent gets wrong or refuses, one a line; heights in inches."""
    rechecks = {(one.wrong.method.name, one.wrong.case.pose_deg): one for one in found.rechecks}
    lines = [
        "method,roll_deg,pitch_deg,phase_deg,outcome,height_in,exact_height_in,beside_event,by_finer_meshes,reason"
    ]
    for number, method in enumerate(found.extent.descents):
        for row in found.descents:
            for pose, outcome, height, exact in zip(
                row.poses_deg, row.outcomes(number), row.heights[number], row.exact, strict=True
            ):
                if outcome is not Outcome.RIGHT:
                    angles = ",".join(f"{angle:g}" for angle in pose)
                    computed = "" if height.height is None else f"{height.height:.9f}"
                    true = "" if exact is None else f"{exact:.9f}"
                    recheck = rechecks.get((method.name, pose))
                    checked = (
                        "," if recheck is None else f"{'yes' if recheck.beside_event else 'no'},{recheck.finer.value}"
                    )
                    lines.append(
                        f'"{method.name}",{angles},{outcome.value},{computed},{true},{checked},"{height.reason}"'
                    )
    return "\n".join(lines) + "\n"


def decade_rows(found: Findings) -> list[OutcomeRow]:
    """The outcomes of the descent in decades, for its map."""
    number = next(i for i, one in enumerate(found.extent.descents) if one.descent is Descent.DECADES)
    return [OutcomeRow(row.roll_deg, row.pitch_deg, row.outcomes(number)) for row in found.descents]


OF_WRONG = tuple(one for one in Outcome if one.is_wrong)


def demonstrations_table(found: Findings) -> str:
    """Every way to fail at one pose, with what each method does."""
    methods = [rival.method.name for rival in found.extent.rivals if rival.demonstrated]
    rows = []
    for one in found.shown:
        case, exact = one.demonstration.case, one.exact
        roll, pitch, phase = case.pose_deg
        said = _exactly(exact, case.scale) if isinstance(exact, ContactState) else f"refused: {exact.reason}"
        replies = [in_words(reply, exact, case.scale) for reply in one.replies]
        pose = f"{roll!r}, {pitch!r}, {phase!r}"
        rows.append((f"**{one.demonstration.mode}**: {one.demonstration.why}", pose, said, *replies))
    return table(("where, and why methods fail there", "roll, pitch, phase", "exact", *methods), rows)


def _exactly(state: ContactState, scale: float) -> str:
    turns = [f"{turn:.5g}" for turn in (state.lambda_deg, state.mu_deg) if turn is not None]
    parts = [f"{state.poses[0].translation[2] / scale:.6f} in"]
    if turns:
        parts.append(f"turns {', '.join(turns)} deg")
    return "; ".join([*parts, state.state_class.value.replace("_", " "), *(flag.value for flag in state.flags)])


def places_table(found: Findings) -> str:
    """Of every method at every place: wrong and refused of the cases asked."""
    names = list(found.rivals)
    rows = []
    for number, (place, tally) in enumerate(zip(found.places, found.tallies, strict=True)):
        exact = f"{len(tally.failures):,} / {tally.refused:,} / {tally.trials:,}"
        rows.append((place.name, exact, *(_counted(found.rivals[name][number]) for name in names)))
    total = found.total
    exact = f"{len(total.failures):,} / {total.refused:,} / {total.trials:,}"
    rows.append(("**all**", exact, *(_counted(all_places(found.rivals[name])) for name in names)))
    return table(("wrong / refused / total", "exact", *names), rows)


def _counted(tally: RivalTally) -> str:
    wrong = sum(tally.outcomes[one] for one in OF_WRONG)
    return f"{wrong:,} / {tally.outcomes[Outcome.REFUSED]:,} / {tally.case_count:,}"


def all_places(tallies: Sequence[RivalTally]) -> RivalTally:
    """All places together."""
    total = RivalTally()
    for tally in tallies:
        total.add(tally)
    return total


def wrong_table(found: Findings) -> str:
    """What wrong answers of the meshes are wrong in, and how their classes flip."""
    rows = []
    for name, tallies in found.rivals.items():
        total = all_places(tallies)
        flips = (total.flips_within, total.flips_at_events, total.flips_beyond)
        unknown = total.outcomes[Outcome.NO_TRUTH]
        counts = [*(total.outcomes[one] for one in OF_WRONG), unknown, *flips]
        rows.append((name, *(f"{count:,}" for count in counts)))
    head = ("method", *(one.value for one in OF_WRONG), Outcome.NO_TRUTH.value)
    return table((*head, "flips within margins", "flips with other contacts", "flips beyond margins"), rows)


def change_tables(found: Findings) -> Iterator[str]:
    """The largest changes of each method's answers by the size of the perturbation."""
    names = {"exact": found.total.largest} | {
        name: all_places(tallies).largest for name, tallies in found.rivals.items()
    }
    for index, what in enumerate(("height of the first contact", "turn times the bolt's reach", "contact point")):
        rows = [
            (name, *(f"{largest[d][index]:.0e}" if d in largest else "" for d in DECADES))
            for name, largest in names.items()
        ]
        yield f"Largest change of a {what} (in) by the size of the perturbation, where the contacts stay:"
        yield table(("method", *(f"1e{decade}" for decade in DECADES)), rows)


def reasons_text(found: Findings) -> str:
    """Why meshes refuse."""
    reasons = Counter[str]()
    for tallies in found.rivals.values():
        reasons.update(all_places(tallies).reasons)
    return "\n".join(f"- {count:,} times: {reason}" for reason, count in reasons.most_common()) or "- never"


def pitfalls_text(found: Findings) -> str:
    """What the library's unfiltered pairs would give."""
    pitfalls = found.pitfalls
    met = ", ".join(f"{pitfalls.types[kind]:,} of type {kind.name}" for kind in Intersection)
    return (
        f"- **Two contacts averaged into one.** At the second contact of roll -4, pitch 0, phase 131 the colliding "
        f"triangles form {pitfalls.clusters} clusters. The mean of all their midpoints is {pitfalls.averaged_off:.3f} "
        f"in off the nearer contact, inside both parts.\n"
        f"- **Coplanar triangles.** Where the bolt of roll 4, pitch 0, phase 185 has come to lie flush, "
        f"{pitfalls.flush_pairs:,} pairs of triangles collide; {pitfalls.flush_pairs - pitfalls.flush_met:,} of them "
        f"have no segment in common, since their planes are one.\n"
        f"- **Pairs returned without an intersection** (the paper's type IV). In the first contacts of "
        f"{pitfalls.poses:,} random poses the library returned {pitfalls.types.total():,} pairs of triangles: {met}. "
        f"In {pitfalls.poses_without_contact:,} poses one of them does not meet."
    )


def wrong_csv(found: Findings) -> str:
    """Every wrong answer of the meshes, one a line."""
    lines = ["method,place,outcome,case"]
    for name, tallies in found.rivals.items():
        for place, tally in zip(found.places, tallies, strict=True):
            lines += [f'"{name}","{place.name}","{one.outcome.value}","{one.case}"' for one in tally.wrong]
    return "\n".join(lines) + "\n"
