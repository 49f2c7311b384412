"""``threadstate threads``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Json
from worker.output import print_json


def threads(
    search: Annotated[
        str | None,
        typer.Option(
            "--search",
            metavar="TEXT",
            help="A designation, with tolerance classes or without, or words that it contains.",
            show_default="all",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    r"""List standard threads with the limits of their diameters, each with the classes that are usual for it.

    --pair takes all of these, with "LH" and "at minimum material" or the like behind it.

    \b
    Examples:
      threadstate threads
      threadstate threads --search "1/4-20 UNC-3A/3B"
      threadstate threads --search unef --json
      threadstate threads --search M6
    """
    from threadstate.thread.standards.designation import found_threads
    from threadstate.thread.standards.document import standard_thread_list
    from worker.tables import print_threads

    found = found_threads(search)
    if as_json:
        print_json(standard_thread_list(found))
    else:
        print_threads(found)
