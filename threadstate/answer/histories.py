"""Histories of orientations as documents, stored or computed on demand."""

from __future__ import annotations

from threadstate.answer.changes import change_documents
from threadstate.answer.documents import BoundaryDocument, IntervalDocument, OrientationHistoryDocument
from threadstate.answer.formations import formation_document
from threadstate.answer.lengths import scaled, sides
from threadstate.answer.windows import window_document
from threadstate.archive.read import formations, orientation_history
from threadstate.archive.rows import history_rows
from threadstate.archive.stored import OrientationHistory, StoredBoundary, StoredHeights
from threadstate.history.build import history_of
from threadstate.history.window import windows_of
from threadstate.network.cells import Cell
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair


def computed_history(
    pair: Pair, roll_deg: float, pitch_deg: float, options: SolveOptions | None = None
) -> OrientationHistory:
    """The history of any orientation, as a library stores it; its cells have orientation 0.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    history = history_of(pair, roll_deg, pitch_deg, options)
    rows = history_rows(history, windows_of(pair, history))
    return orientation_history(0, rows, formations(rows.formations))


def history_document(
    history: OrientationHistory, roll_deg: float, pitch_deg: float, thread_pitch: float, factor: float
) -> OrientationHistoryDocument:
    """The document of an orientation's history, lengths multiplied by ``factor``; ``thread_pitch`` before that."""
    keys = [cell.formation.key for cell in history.cells]
    return OrientationHistoryDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        intervals=[
            _interval(cell, heights, factor) for cell, heights in zip(history.cells, history.heights, strict=True)
        ],
        boundaries=[_boundary(boundary, keys[i - 1], keys[i], factor) for i, boundary in enumerate(history.boundaries)],
        windows=[window_document(one, roll_deg, pitch_deg, thread_pitch, factor) for one in history.windows],
    )


def _interval(cell: Cell, heights: StoredHeights, factor: float) -> IntervalDocument:
    return IntervalDocument(
        start=cell.start_deg,
        end=cell.end_deg,
        formation=formation_document(cell.formation),
        flags=list(cell.flags),
        margin=scaled(cell.margin, factor),
        first_height=scaled(heights.first, factor),
        last_height=scaled(heights.last, factor),
        in_window=cell.in_window,
    )


def _boundary(boundary: StoredBoundary, before: str, after: str, factor: float) -> BoundaryDocument:
    return BoundaryDocument(
        phase=boundary.phase_deg,
        low=boundary.low_deg,
        high=boundary.high_deg,
        before=before,
        after=after,
        first_height=sides(boundary.first_height_before, boundary.first_height_after, factor),
        last_height=sides(boundary.last_height_before, boundary.last_height_after, factor),
        flags_between=list(boundary.flags_between),
        changes=change_documents(boundary.changes, factor),
    )
