"""``threadstate migrate``."""

from __future__ import annotations

from threadstate.settings import read_settings
from worker.options import Database, Json
from worker.output import print_json, print_line


def migrate(database: Database = None, as_json: Json = False) -> None:
    r"""Bring the database up to date; make it if there is none.

    Older libraries stay, and data that their histories lack is computed: a quarter to one second an orientation.

    \b
    Examples:
      threadstate migrate
      threadstate migrate --database sqlite:////tmp/threads.sqlite3
      threadstate migrate --database postgresql+psycopg://threads@db.example/threads
    """
    from threadstate.library.engine import writing
    from threadstate.library.schema import location
    from worker.migrate import migrate as bring_up_to_date

    with writing(database or read_settings().database) as engine:
        migration = bring_up_to_date(engine)
        where = location(engine)
    if as_json:
        print_json({"before": migration.before, "after": migration.after, "completed": migration.completed})
    elif migration.before == migration.after:
        print_line(f"{where} is at revision {migration.after} already")
    else:
        print_line(f"{where} is now at revision {migration.after}")
    if migration.completed and not as_json:
        print_line(f"descents of {migration.completed} orientations were added to their histories")
