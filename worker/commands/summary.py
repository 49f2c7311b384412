"""``threadstate summary``."""

from __future__ import annotations

from threadstate.library.method import Method
from threadstate.settings import read_settings
from worker.options import Database, Json, MethodName
from worker.output import print_json, print_line


def summary(database: Database = None, method: MethodName = Method.EXACT, as_json: Json = False) -> None:
    r"""Print what the latest library of a method holds: how many states of each class, and with each flag.

    \b
    Examples:
      threadstate summary
      threadstate summary --database sqlite:////tmp/threads.sqlite3 --json
    """
    from threadstate.library.engine import reading
    from threadstate.library.read import counts, latest_library, undecided_reasons
    from threadstate.library.schema import check_schema

    with reading(database or read_settings().database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            library = latest_library(connection, method=method)
            counted = counts(connection, library.id)
            reasons = undecided_reasons(connection, library.id)
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
                "method": library.method.value,
                "states": library.state_count,
                "undecided": dict(reasons),
                "classes": {name.value: count for name, count in counted.of_class},
                "flags": {name.value: count for name, count in counted.of_flag},
            }
        )
        return
    method_and_unit = f"{library.method.value} method, unit {library.length_unit}"
    print_line(f"library {library.id}: {library.designation}, {library.state_count} states, {method_and_unit}")
    print_line(f"published {library.published_at:%Y-%m-%d %H:%M:%S} UTC by {library.code_version}")
    print_line(f"inputs  {library.input_sha256}")
    print_line(f"content {library.content_sha256}")
    for title, rows in (("class", counted.of_class), ("flag", counted.of_flag)):
        print_line(f"\n{title:<24}{'states':>8}")
        for name, count in rows:
            print_line(f"{name.value:<24}{count:>8}")
    if reasons:
        print_line(f"\n{'poses':>8}  undecided, as")
        for reason, count in reasons:
            print_line(f"{count:>8}  {reason}")
