"""``threadstate summary``."""

from __future__ import annotations

from threadstate.settings import read_settings
from worker.options import Database, Json
from worker.output import print_json, print_line


def summary(database: Database = None, as_json: Json = False) -> None:
    r"""Print what the latest published library holds: how many states of each class, and with each flag.

    \b
    Examples:
      threadstate summary
      threadstate summary --database sqlite:////tmp/threads.sqlite3 --json
    """
    from threadstate.library.engine import reader_engine
    from threadstate.library.read import counts, latest_library
    from threadstate.library.schema import check_schema

    engine = reader_engine(database or read_settings().database)
    check_schema(engine)
    with engine.connect() as connection:
        library = latest_library(connection)
        counted = counts(connection, library.id)
    if as_json:
        print_json(
            {
                "library": library.id,
                "pair": library.designation,
                "unit": library.length_unit.value,
                "input_sha256": library.input_sha256,
                "content_sha256": library.content_sha256,
                "code_version": library.code_version,
                "published_at": library.published_at.isoformat(),
                "states": library.state_count,
                "classes": {name.value: count for name, count in counted.of_class},
                "flags": {name.value: count for name, count in counted.of_flag},
            }
        )
        return
    print_line(f"library {library.id}: {library.designation}, {library.state_count} states, unit {library.length_unit}")
    print_line(f"published {library.published_at:%Y-%m-%d %H:%M:%S} UTC by {library.code_version}")
    print_line(f"inputs  {library.input_sha256}")
    print_line(f"content {library.content_sha256}")
    for title, rows in (("class", counted.of_class), ("flag", counted.of_flag)):
        print_line(f"\n{title:<24}{'states':>8}")
        for name, count in rows:
            print_line(f"{name.value:<24}{count:>8}")
