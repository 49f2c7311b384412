"""What the page says of all methods beside each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from studies.stability.agreement import Outcome
from studies.stability.demonstrations import in_words
from studies.stability.findings import Findings
from studies.stability.rival_tally import RivalTally
from studies.stability.table import table
from studies.stability.trials import DECADES
from threadstate.mesh.segments import Intersection
from threadstate.state.model import ContactState

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
    return table(("wrong / refused / asked", "exact", *names), rows)


def _counted(tally: RivalTally) -> str:
    wrong = sum(tally.outcomes[one] for one in OF_WRONG)
    return f"{wrong:,} / {tally.outcomes[Outcome.REFUSED]:,} / {tally.asked:,}"


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


def traps_text(found: Findings) -> str:
    """What the library's pairs would say as they come."""
    traps = found.traps
    met = ", ".join(f"{traps.types[kind]:,} of type {kind.name}" for kind in Intersection)
    return (
        f"- **Two contacts averaged into one.** At the second contact of roll -4, pitch 0, phase 131 the colliding "
        f"triangles form {traps.clusters} clusters. The mean of all their midpoints is {traps.averaged_off:.3f} in off "
        f"the nearer contact, inside both parts.\n"
        f"- **Coplanar triangles.** Where the bolt of roll 4, pitch 0, phase 185 has come to lie flush, "
        f"{traps.flush_pairs:,} pairs of triangles collide; {traps.flush_pairs - traps.flush_met:,} of them have no "
        f"segment in common, since their planes are one.\n"
        f"- **Pairs returned without an intersection** (the paper's type IV). In the first contacts of {traps.poses:,} "
        f"random poses the library returned {traps.types.total():,} pairs of triangles: {met}. In {traps.fooled:,} "
        f"poses one of them does not meet."
    )


def wrong_csv(found: Findings) -> str:
    """Every wrong answer of the meshes, one a line."""
    lines = ["method,place,outcome,case"]
    for name, tallies in found.rivals.items():
        for place, tally in zip(found.places, tallies, strict=True):
            lines += [f'"{name}","{place.name}","{one.outcome.value}","{one.case}"' for one in tally.wrong]
    return "\n".join(lines) + "\n"
