"""Small cell maps: made by hand, and drawn at random with every boundary at a multiple of 45 deg."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

from threadstate.history.labels import ContactLabels
from threadstate.network.cells import Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import Region

TICK_DEG = 45.0
TICKS = 8

ON_SURFACE = ContactLabels(1, Region.FLANK_NEG, Region.SURFACE, FeaturePair.EDGE_SURFACE)
ON_EDGE = ContactLabels(1, Region.CREST, Region.ROOT, FeaturePair.EDGE_EDGE)
SECOND = ContactLabels(2, Region.FLANK_POS, Region.FLANK_NEG, FeaturePair.EDGE_EDGE)
THIRD = ContactLabels(3, Region.BASE, Region.CREST, FeaturePair.BASE_EDGE)

UNDECIDED = Formation(None, ())
A = Formation(StateClass.UNSTABLE_TWO_POINT, (ON_SURFACE, SECOND))
B = Formation(StateClass.STABLE_THREE_POINT, (ON_SURFACE, SECOND, THIRD))
C = Formation(StateClass.STABLE_THREE_POINT, (ON_EDGE, SECOND, THIRD))
FORMATIONS = (A, B, C, UNDECIDED)


def orientation_cells(
    orientation: int,
    starts_deg: Sequence[float],
    formations: Sequence[Formation],
    *,
    window: Sequence[bool] | None = None,
    margins: Sequence[float | None] | None = None,
    flags: Sequence[tuple[Flag, ...]] | None = None,
) -> tuple[Cell, ...]:
    """The cells of an orientation, given where each one begins."""
    count = len(starts_deg)
    ends = [*starts_deg[1:], starts_deg[0] + 360.0]
    rows = zip(
        starts_deg,
        ends,
        formations,
        flags or [()] * count,
        margins or [0.001] * count,
        window or [False] * count,
        strict=True,
    )
    return tuple(Cell(orientation, i, *row) for i, row in enumerate(rows))


@st.composite
def cell_maps(draw: st.DrawFn, largest: int = 3) -> CellMap:
    """A map of up to ``largest`` tilts, with a few formations."""
    count = draw(st.integers(1, largest))
    orientations = []
    for number in range(count**2):
        ticks = sorted(draw(st.sets(st.integers(0, TICKS - 1), min_size=1)))
        if len(ticks) == 1:
            ticks = [0]
        each = len(ticks)
        orientations.append(
            orientation_cells(
                number,
                [TICK_DEG * tick for tick in ticks],
                draw(st.lists(st.sampled_from(FORMATIONS), min_size=each, max_size=each)),
                window=[draw(st.integers(0, 9)) == 0 for _ in ticks],
                margins=draw(st.lists(st.sampled_from([None, 0.0, 1.0, 2.0, 3.0]), min_size=each, max_size=each)),
                flags=draw(st.lists(st.sampled_from([(), (Flag.TIE,)]), min_size=each, max_size=each)),
            )
        )
    return CellMap(tuple(float(i) for i in range(count)), tuple(orientations))
