"""Where along the phase the contacts can hold a load or wedge, as a document."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.network.cells import Cell
from threadstate.responses.documents import HeldDocument, VerdictStretchDocument
from threadstate.state.options import SolveOptions
from threadstate.statics.load import Load
from threadstate.statics.stretches import LoadedOrientation
from threadstate.thread.pair import Pair


def held_documents(
    pair: Pair,
    options: SolveOptions,
    tilt_deg: tuple[float, float],
    cells: Sequence[Cell],
    load: Load,
    mus: Sequence[float],
) -> list[HeldDocument]:
    """What a load does along the phase of an orientation with these intervals, at each friction."""
    intervals = [(one.start_deg, one.end_deg) for one in cells]
    solved = LoadedOrientation(pair, options, *tilt_deg, load)
    return [held_document(solved, intervals, mu) for mu in mus]


def held_document(solved: LoadedOrientation, intervals: Sequence[tuple[float, float]], mu: float) -> HeldDocument:
    """The stretches of an orientation at a friction; those that touch and have the same verdict are joined."""
    joined: list[VerdictStretchDocument] = []
    for of_interval in solved.stretches(intervals, mu):
        for one in of_interval:
            if joined and joined[-1].verdict is one.verdict:
                joined[-1] = joined[-1].model_copy(update={"end": one.end_deg})
            else:
                joined.append(
                    VerdictStretchDocument(
                        start=one.start_deg,
                        end=one.end_deg,
                        verdict=one.verdict,
                        start_uncertainty=one.uncertainty_deg,
                    )
                )
    if len(joined) > 1 and joined[0].verdict is joined[-1].verdict:
        first = joined.pop(0)
        joined[-1] = joined[-1].model_copy(update={"end": first.end + 360.0})
    roll, pitch = solved.tilt_deg
    return HeldDocument(roll=roll, pitch=pitch, mu=mu, stretches=joined)
