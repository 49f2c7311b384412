"""What the page says of the exact method in the hard places, and of the printed angles."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from harness.markdown import table
from studies.stability.brute_force import Event
from studies.stability.findings import Findings
from studies.stability.tally import Failure, Steepest, Tally
from studies.stability.tangent_study import WRONG_DEG, is_wrong
from studies.stability.trials import DECADES

SHOWN_FAILURES = 4
"""Of one kind in one place; all are in the table beside the maps."""


def places_table(found: Findings) -> str:
    """The hard places, and how their centres are made."""
    return table(
        ("place", "how its centres are made", "centres"),
        [(place.name, place.how, f"{len(place.centres)}") for place in found.places],
    )


def answers_text(found: Findings) -> str:
    """What the counts mean."""
    total = found.total
    return (
        "Each centre is perturbed by 1e-12 to 1e-3 (degrees; thread pitches) in nine directions of the pose and three "
        "of the dimensions. Same contacts: the contacts are the centre's. Other contacts: they differ, after the "
        f"events of the next table. Unfollowed: checked by the brute force alone, without a path from the centre "
        f"({total.unfollowed:,}). No centre: the centre itself is refused, so that laws alone are checked "
        f"({total.without_centre:,})."
    )


def answers_table(found: Findings) -> str:
    """What the method does at each place."""
    flips = ("class flips by margin", "class flips at events")
    head = (
        "place",
        "perturbed",
        "refused",
        "same contacts",
        "other contacts",
        "unfollowed",
        "no centre",
        *flips,
        "silent failures",
    )
    rows = [(place.name, *_counts(tally)) for place, tally in zip(found.places, found.tallies, strict=True)]
    return table(head, [*rows, ("**all**", *_counts(found.total))])


def _counts(tally: Tally) -> tuple[str, ...]:
    numbers = (
        tally.trials,
        tally.refused,
        tally.same_contacts,
        tally.other_contacts,
        tally.unfollowed,
        tally.without_centre,
        tally.flips_by_margin,
        tally.flips_at_events,
        len(tally.failures),
    )
    return tuple(f"{number:,}" for number in numbers)


def events_table(found: Findings) -> str:
    """What explains the jumps between neighbours."""
    total = found.total
    rows = [(event.value, f"{total.events[event]:,}") for event in Event if total.events[event]]
    compared = (
        f"Also checked by the brute force: {total.compared_heights:,} heights, {total.compared_turns:,} states' turns, "
        f"{total.compared_lifts:,} embedments."
    )
    return table(("what explains the jump", "neighbours"), rows) + f"\n\n{compared}"


def failures(found: Findings) -> str:
    """The silent failures, some of each kind."""
    rows: list[tuple[str, ...]] = []
    for place, tally in zip(found.places, found.tallies, strict=True):
        seen: Counter[str] = Counter()
        for failure in tally.failures:
            seen[failure.fault] += 1
            if seen[failure.fault] <= SHOWN_FAILURES:
                changed = " (dimensions changed)" if failure.dimensions else ""
                rows.append((place.name, failure.fault.value, failure.pose + changed, failure.detail))
        rows += [
            (place.name, fault, f"and {count - SHOWN_FAILURES} more", "")
            for fault, count in seen.items()
            if count > SHOWN_FAILURES
        ]
    for row in found.rows:
        rows += [("the grid", "a law is broken", broken, "") for broken in row.broken[:SHOWN_FAILURES]]
    if not rows:
        return "None."
    return table(("place", "what is wrong", "pose (deg)", "in detail"), rows)


def failures_csv(found: Findings) -> str:
    """Every silent failure, one a line."""
    lines = ["place,fault,pose_deg,dimensions,detail"]
    for place, tally in zip(found.places, found.tallies, strict=True):
        lines += [_csv_line(place.name, failure) for failure in tally.failures]
    lines += [f'"the grid","a law is broken","{broken}","",""' for row in found.rows for broken in row.broken]
    return "\n".join(lines) + "\n"


def _csv_line(place: str, failure: Failure) -> str:
    return ",".join(
        f'"{value}"' for value in (place, failure.fault.value, failure.pose, failure.dimensions, failure.detail)
    )


def steep_table(found: Findings) -> str:
    """The steepest slopes."""
    head = ("place", "height", "turn", "point", "steepest point about")
    return table(
        head,
        [
            (place.name, _ratio(tally.height), _ratio(tally.turn), _ratio(tally.point), tally.point.where)
            for place, tally in zip(found.places, found.tallies, strict=True)
            if tally.largest
        ],
    )


def _ratio(steepest: Steepest) -> str:
    return f"{steepest.ratio:.2g}"


def decade_tables(found: Findings) -> Iterable[str]:
    """The largest changes by the size of the perturbation."""
    for index, name in enumerate(("height of the first contact", "turn times the bolt's reach", "contact point")):
        rows = [
            (place.name, *(f"{tally.largest[d][index]:.0e}" if d in tally.largest else "" for d in DECADES))
            for place, tally in zip(found.places, found.tallies, strict=True)
            if tally.largest
        ]
        yield f"Largest change of a {name} (in) by the size of the perturbation, where the contacts stay:"
        yield table(("place", *(f"1e{decade}" for decade in DECADES)), rows)


def angles_text(found: Findings) -> str:
    """How often each printed equation is off."""
    poses = [pose.directions for row in found.rows for pose in row.poses]
    shares = []
    for equation, errors in (
        ("Eq. 7 (tangent, nut's frame)", [one.nut_tangent for one in poses]),
        ("Eq. 9 (tangent, bolt's frame)", [one.bolt_tangent for one in poses]),
        ("Eq. 11 (pivot axis, contact's frame)", [one.pivot_axis for one in poses]),
    ):
        known = [error for error in errors if error is not None]
        none = sum(error != error for error in known)
        shares.append(
            f"- {equation}: off by more than {WRONG_DEG:g} deg in {sum(map(is_wrong, known)):,} of {len(known):,} "
            f"poses of the grid, of which {none:,} have no number at all."
        )
    return (
        "The paper turns the x axis into a tangent by `acos(x / sin(acos z))` about z. That loses the sign of the y "
        "part, half of the digits beside +-x, and everything beside +-z, where it divides by zero. `atan2(y, x)` and "
        "`-atan2(z, hypot(x, y))` do not; the project uses neither pair of angles but the vectors themselves.\n\n"
        + "\n".join(shares)
        + "\n\nBeside each axis, 16 directions at each of the angles 0, 1e-16, 1e-12, 1e-8, 1e-4 and 0.01 rad from it:"
    )


def axes_table(found: Findings) -> str:
    """Both formulas beside the six axes."""
    head = ("axis", "directions", "no number", f"off by more than {WRONG_DEG:g} deg", "largest error, printed (deg)")
    return table(
        (*head, "largest error, atan2 (deg)"),
        [
            (
                one.axis,
                f"{one.directions}",
                f"{one.without_number}",
                f"{one.wrong}",
                f"{one.printed_deg:.2g}",
                f"{one.two_argument_deg:.1e}",
            )
            for one in found.axes
        ],
    )
