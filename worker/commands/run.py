"""``threadstate run``."""

from __future__ import annotations

from threadstate.settings import read_settings
from worker.commands.migrate import migrate
from worker.commands.rebuild import rebuild
from worker.commands.serve import serve
from worker.options import Database, Dimensions, Host, PairName, PhaseStep, Port, TiltMax, TiltStep, Workers


def run(
    database: Database = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    phase_step: PhaseStep = 1.0,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    workers: Workers = None,
    host: Host = None,
    port: Port = None,
) -> None:
    r"""Migrate the database, compute the library unless it is published already, and serve it.

    \b
    Examples:
      threadstate run
      threadstate run --phase-step 5 --port 8080
      threadstate run --pair examples/m6x1.toml
    """
    from worker.serving import check_address

    settings = read_settings()
    # Before the library is computed, which takes a while.
    check_address(host or settings.host, port or settings.port)
    migrate(database)
    rebuild(database, pair, dimension, phase_step, tilt_max, tilt_step, workers)
    serve(database, host, port)
