"""Falls and windows of a library's orientations, stored or computed, for the commands that print them."""

from __future__ import annotations

from threadstate.errors import InvalidValueError
from threadstate.history.falls import SNAP_PITCHES, SPAN_DEG
from threadstate.numbers import number_text
from threadstate.responses.documents import OrientationWindowsDocument
from threadstate.responses.falls_range import computed_falls
from threadstate.responses.histories import computed_history
from threadstate.responses.library_network import LibraryNetwork
from threadstate.responses.windows import windows_document, windows_of_histories
from worker.output import print_status
from worker.progress import with_progress


def falls_and_windows(
    network: LibraryNetwork,
    roll_deg: float | None,
    pitch_deg: float | None,
    factor: float,
    span_deg: float = SPAN_DEG,
    least_pitches: float = SNAP_PITCHES,
) -> list[OrientationWindowsDocument]:
    """The falls and windows of all orientations of the grid, of one roll or pitch, or of any one orientation.

    Lengths are multiplied by ``factor``. Falls that the library does not store are computed: those of an orientation
    off its grid, which is reported on stderr, and steepest falls within another span.

    Raises:
        InvalidValueError: a single angle that is not on the grid, or a value out of range.
    """
    pair, tilts = network.pair, network.library.grid.tilts_deg
    off_grid = [
        (name, angle)
        for name, angle in (("roll", roll_deg), ("pitch", pitch_deg))
        if angle is not None and angle not in tilts
    ]
    if off_grid and roll_deg is not None and pitch_deg is not None:
        name, angle = off_grid[0]
        print_status(f"computed: {name} {number_text(angle)} is not on the grid of library {network.library.id}")
        history = computed_history(pair, roll_deg, pitch_deg, network.options)
        found = [windows_document(history, roll_deg, pitch_deg, pair, factor, least_pitches)]
    elif off_grid:
        name, angle = off_grid[0]
        valid = f"one of {', '.join(map(number_text, tilts))} deg; any angle where roll and pitch are both given"
        raise InvalidValueError(f"--{name}", angle, valid)
    else:
        found = windows_of_histories(network.histories, roll_deg, pitch_deg, pair, factor, least_pitches)
    if span_deg == SPAN_DEG:
        return found
    return [
        one.model_copy(
            update=dict(computed_falls(pair, network.options, one.roll, one.pitch, factor, span_deg, least_pitches))
        )
        for one in with_progress(found, "orientations")
    ]
