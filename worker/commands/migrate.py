"""``threadstate migrate``."""

from __future__ import annotations

from threadstate.settings import read_settings
from worker.options import Database, Json
from worker.output import print_json, print_line


def migrate(database: Database = None, as_json: Json = False) -> None:
    r"""Bring the database's schema up to date; makes the database if there is none.

    \b
    Examples:
      threadstate migrate
      threadstate migrate --database sqlite:////tmp/threads.sqlite3
    """
    from threadstate.library.engine import writer_engine
    from worker.migrate import migrate as bring_up_to_date

    engine = writer_engine(database or read_settings().database)
    migration = bring_up_to_date(engine)
    if as_json:
        print_json({"before": migration.before, "after": migration.after})
    elif migration.before == migration.after:
        print_line(f"{engine.url.database} is at revision {migration.after} already")
    else:
        print_line(f"{engine.url.database} is now at revision {migration.after}")
