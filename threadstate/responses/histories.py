"""Histories of orientations as documents, stored or computed on demand."""

from __future__ import annotations

from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.records import RecordStore
from threadstate.history.window import windows_of
from threadstate.network.cells import Cell
from threadstate.responses.documents import BoundaryDocument, IntervalDocument, OrientationHistoryDocument
from threadstate.responses.formations import change_documents, formation_document
from threadstate.responses.windows import windows_document
from threadstate.state.options import SolveOptions
from threadstate.stored_histories.mapping import formations, orientation_history
from threadstate.stored_histories.model import StoredBoundary, StoredHeights, StoredHistory
from threadstate.stored_histories.rows import history_rows
from threadstate.thread.pair import Pair
from threadstate.units import scale_length, scale_pair


def computed_history(
    pair: Pair, roll_deg: float, pitch_deg: float, options: SolveOptions | None = None
) -> StoredHistory:
    """The history of any orientation, as a library stores it; its cells have orientation 0.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    options = options or SolveOptions()
    store = RecordStore(pair, options)
    (history,) = histories_of(pair, [(roll_deg, pitch_deg)], options, store=store)
    falls = falls_of(height_curve(pair, roll_deg, pitch_deg, options, store), pair.thread_pitch)
    rows = history_rows(history, windows_of(pair, history), falls)
    return orientation_history(0, rows, formations(rows.formations))


def history_document(
    history: StoredHistory, roll_deg: float, pitch_deg: float, pair: Pair, factor: float
) -> OrientationHistoryDocument:
    """The document of an orientation's history, lengths multiplied by ``factor``; ``thread_pitch`` before that."""
    keys = [cell.formation.key for cell in history.cells]
    return OrientationHistoryDocument(
        **dict(windows_document(history, roll_deg, pitch_deg, pair, factor)),
        intervals=[
            _interval(cell, heights, factor) for cell, heights in zip(history.cells, history.heights, strict=True)
        ],
        boundaries=[_boundary(boundary, keys[i - 1], keys[i], factor) for i, boundary in enumerate(history.boundaries)],
    )


def _interval(cell: Cell, heights: StoredHeights, factor: float) -> IntervalDocument:
    return IntervalDocument(
        start=cell.start_deg,
        end=cell.end_deg,
        formation=formation_document(cell.formation),
        flags=list(cell.flags),
        margin=scale_length(cell.margin, factor),
        first_height=scale_length(heights.first, factor),
        last_height=scale_length(heights.last, factor),
        in_window=cell.in_window,
    )


def _boundary(boundary: StoredBoundary, before: str, after: str, factor: float) -> BoundaryDocument:
    return BoundaryDocument(
        phase=boundary.phase_deg,
        low=boundary.low_deg,
        high=boundary.high_deg,
        before=before,
        after=after,
        first_height=scale_pair(boundary.first_height_before, boundary.first_height_after, factor),
        last_height=scale_pair(boundary.last_height_before, boundary.last_height_after, factor),
        flags_between=list(boundary.flags_between),
        changes=change_documents(boundary.changes, factor),
    )
