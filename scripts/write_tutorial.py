"""Runs the commands of docs/tutorial.md and writes what they print into it (``make tutorial``).

Commands are run in order on the database of the settings, whose only library of 1/4-20 UNC is that of the default grid.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from harness.running_service import running_service
from scripts.shown_commands import Terminal, saved_files, written_again
from threadstate.settings import read_settings

PAGE = Path(__file__).parent.parent / "docs" / "tutorial.md"


def main() -> None:
    """Write the page again."""
    page = PAGE.read_text()
    with running_service(read_settings().database) as address, tempfile.TemporaryDirectory() as folder:
        terminal = Terminal(address, Path(folder), saved_files(page))
        PAGE.write_text(written_again(page, terminal.run))


if __name__ == "__main__":
    main()
