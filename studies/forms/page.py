"""The page of forms beside the brute force."""

from __future__ import annotations

from collections.abc import Sequence

from harness.markdown import table
from studies.forms.study import HEIGHT_PITCHES, NEAR_PHASE_DEG, TILT_DEG, Found
from threadstate.numbers import number_text

CORNERS = ("bolt crest_fillet", "bolt root_fillet", "nut crest_fillet", "nut root_fillet")
AT_CORNERS = tuple(f"at {one.replace('_', ' ')}" for one in CORNERS)
BESIDE = ("pair", "heights", "above", "refused", "contacts", "turns", "onsets", *AT_CORNERS, "faults")
CHANGED = (
    "pair",
    "centres",
    "changed",
    "refused",
    "same contacts",
    "across an event",
    "not followed",
    "failures",
)


def page(forms: Sequence[str], found: Sequence[Found]) -> str:
    """The page as Markdown."""
    rows = list(zip(forms, found, strict=True))
    faults = [f"- {form}, {fault}" for form, one in rows for fault in one.faults]
    silent = [
        f"- {form}, {failure.pose}: {failure.fault.value}, {failure.detail}"
        for form, one in rows
        for failure in one.perturbed.failures
    ]
    everything = Found()
    for one in found:
        everything.add(one)
    tried = everything.perturbed
    return f"""# Forms checked

`make forms` writes this page: the exact method on [standard threads](threads.md) of every form, each in a small size,
at maximum and at minimum material, and with sharp corners in place of fillets
([decision 25](decisions/0025-sharp-corners.md)). Poses are random, roll and pitch within {number_text(TILT_DEG)} deg,
every other one within {number_text(NEAR_PHASE_DEG)} deg of in phase.

A run of `--heights 1000 --turns 200 --centres 68` takes some 20 minutes on two cores. Here,
in all: {everything.heights:,} heights and {everything.turns:,} poses' turns with {len(faults)} faults;
{tried.trials:,} changed poses and dimensions with {len(silent)} silent failures, {tried.refused:,} refused.

## Beside the brute force

The brute force (`oracle`) knows nothing of the solver. A height differs from its height by at most
{number_text(HEIGHT_PITCHES)} thread pitches, or is *above*: there the samples stepped over a narrow pocket, and the
contact, which lies on both surfaces, is proof. Every contact lies on the surfaces that its features name to 2e-8
thread pitches, with the normal and the regions that belong there, and the other [laws](method.md) of a state hold.
*Turns*: no turn of the pose passes a contact onset, and each *onset* that ends one is where an overlap begins, looked
1e-4 to 1e-6 deg before and after. *At* a fillet: contacts on it, or on the sharp corner in its place.

{table(BESIDE, [_beside(form, one) for form, one in rows])}

## Under perturbation

Centres are changed as in the [stability study](stability.md): poses and dimensions by 1e-12 to 1e-3 deg and thread
pitches. A changed answer has to follow from its centre's, by steady steps and across events that the brute force
explains; what does not is a silent failure.

{table(CHANGED, [_changed(form, one) for form, one in rows])}
{_listed("Faults", faults)}{_listed("Silent failures", silent)}"""


def _beside(form: str, one: Found) -> list[str]:
    numbers = (one.heights, one.proved, one.refused, one.contacts, one.turns, one.onsets)
    return [form, *(f"{n:,}" for n in (*numbers, *(one.corners[name] for name in CORNERS), len(one.faults)))]


def _changed(form: str, one: Found) -> list[str]:
    tally = one.perturbed
    numbers = (
        tally.centres,
        tally.trials,
        tally.refused,
        tally.same_contacts,
        tally.other_contacts,
        tally.unfollowed,
    )
    return [form, *(f"{n:,}" for n in (*numbers, len(tally.failures)))]


def _listed(title: str, lines: Sequence[str]) -> str:
    return "\n".join(["", f"## {title}", "", *lines, ""]) if lines else ""
