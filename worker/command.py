"""The command ``threadstate``, which is installed with the client too: there it says which extra it needs."""

from __future__ import annotations

import sys

from threadstate.errors import MissingExtraError

OURS = ("threadstate", "worker")


def main() -> None:
    """Run the command line on the arguments of this process."""
    try:
        from worker.cli import main as run
    except ModuleNotFoundError as error:
        if str(error.name).partition(".")[0] in OURS:
            raise
        sys.exit(f"threadstate: {MissingExtraError('the command line', 'service')}")
    run()
