"""The requests to both servers, and those to the service alone."""

from __future__ import annotations

from urllib.parse import urlencode

from benchmarks.load.wrk import RequestPattern
from threadstate.library.tables import contact, stage_pose, state, state_flag

TILTS, PHASES = (-4, 4), (0, 359)
_LIBRARY = "/v1/libraries/latest"

POSE = RequestPattern(f"{_LIBRARY}/states/%d/%d/%d", (TILTS, TILTS, PHASES))
HISTORY = RequestPattern(f"{_LIBRARY}/histories/%d/%d", (TILTS, TILTS))
HISTORY_FROM_ROWS = RequestPattern(f"{_LIBRARY}/histories/%d/%d?unit=mm", (TILTS, TILTS))
ZIPPED_HISTORY = RequestPattern(HISTORY.path, HISTORY.ranges, (("Accept-Encoding", "gzip"),))
INTERVALS = RequestPattern(f"{_LIBRARY}/histories/%d/%d/intervals", (TILTS, TILTS))
ONE_HISTORY = f"{_LIBRARY}/histories/4/-3"


def not_modified(etag: str) -> RequestPattern:
    """A conditional request for a history that the client has."""
    return RequestPattern(ONE_HISTORY, headers=(("If-None-Match", etag),))


def _objects(table: str, columns: list[str], order: str) -> str:
    """All rows of a state in a table as a JSON array."""
    pairs = ", ".join(f"'{column}', {column}" for column in columns)
    return (
        f"(SELECT json_group_array(json_object({pairs})) FROM (SELECT * FROM {table} AS t WHERE "
        f"t.library_id = s.library_id AND t.ordinal = s.ordinal ORDER BY {order})) AS {table}s"
    )


def _columns(table: object) -> list[str]:
    return [column.name for column in table.columns if column.name not in ("library_id", "ordinal")]  # type: ignore[attr-defined]


_STATE = ", ".join(
    [
        *(f's."{column}"' for column in _columns(state)),
        _objects("stage_pose", _columns(stage_pose), "stage"),
        _objects("contact", _columns(contact), "position"),
        _objects("state_flag", _columns(state_flag), "position"),
    ]
)
_OF_LATEST = (
    f"SELECT {_STATE} FROM state AS s WHERE s.library_id = "
    "(SELECT id FROM library WHERE published_at IS NOT NULL ORDER BY published_at DESC, id DESC LIMIT 1) "
    "AND s.roll_deg = :roll AND s.pitch_deg = :pitch"
)


def _by_sql(sql: str, *names: str) -> str:
    query = urlencode({"sql": sql, "_shape": "array"}).replace("%", "%%")
    return f"/threadstate.json?{query}" + "".join(f"&{name}=%d" for name in names)


POSE_BY_DATASETTE = RequestPattern(
    _by_sql(f"{_OF_LATEST} AND s.phase_deg = :phase", "roll", "pitch", "phase"), (TILTS, TILTS, PHASES)
)
HISTORY_BY_DATASETTE = RequestPattern(_by_sql(f"{_OF_LATEST} ORDER BY s.ordinal", "roll", "pitch"), (TILTS, TILTS))
