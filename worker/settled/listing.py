"""The list of the published libraries of settled states."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.device.document import device_document
from threadstate.library.engine import reading
from threadstate.library.schema import check_schema
from threadstate.settled.read import SettledLibrary, settled_libraries
from worker.output import print_json, print_status
from worker.tables import table


def list_settled(database: str, *, as_json: bool) -> None:
    """Print the libraries, the latest first.

    Raises:
        SchemaError: the database does not exist or is at another revision.
    """
    with reading(database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            published = settled_libraries(connection)
    if as_json:
        print_json({"settled": [_document(one) for one in published]})
    else:
        _print(published)


def _document(record: SettledLibrary) -> dict[str, object]:
    return {
        "id": record.id,
        "designation": record.designation,
        "unit": record.length_unit.value,
        "device": device_document(record.device),
        "tilt_max": record.grid.tilt_max_deg,
        "tilt_step": record.grid.tilt_step_deg,
        "phase_step": record.grid.phase_step_deg,
        "states": record.grid.pose_count,
        "published_at": record.published_at.isoformat(),
        "code_version": record.code_version,
        "content_sha256": record.content_sha256,
    }


def _print(published: Sequence[SettledLibrary]) -> None:
    if not published:
        print_status("no library of settled states is published yet; run `threadstate rebuild-settled`")
    rows = table("id", "designation", "grid", "states", "unit", "published (UTC)", "device", words_last=True)
    for one in published:
        rows.add_row(
            str(one.id),
            one.designation,
            str(one.grid),
            str(one.grid.pose_count),
            one.length_unit.value,
            f"{one.published_at:%Y-%m-%d %H:%M:%S}",
            ", ".join(f"{name} {value}" for name, value in device_document(one.device).items()),
        )
    rows.print()
