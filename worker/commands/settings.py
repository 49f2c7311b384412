"""``threadstate settings``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from worker.options import Dimensions, Json, PairName
from worker.output import print_json, print_line


def settings(pair: PairName = None, dimension: Dimensions = None, as_json: Json = False) -> None:
    r"""Print all settings, and the pair in force with its dimensions.

    Passwords and keys are not shown.

    \b
    Examples:
      threadstate settings
      threadstate settings --json
      threadstate settings --pair examples/m6x1.toml
    """
    from dataclasses import asdict

    from threadstate.thread.catalogue import source_of
    from worker.effective_settings import effective_settings
    from worker.pairs.selection import chosen_pair
    from worker.tables import table

    found = effective_settings()
    threads = chosen_pair(pair, dimension or ())
    # A flank's own angle and a chamfer are there only where a pair has them.
    form = {name: value for name, value in asdict(threads.form).items() if value is not None}
    dimensions = {**asdict(threads), "form": form, "source": source_of(threads)}
    if threads.chamfer is None:
        del dimensions["chamfer"]
    if as_json:
        entries = [{"name": one.name, "value": one.value, "source": one.source.value} for one in found]
        print_json({"settings": entries, "pair": dimensions})
        return
    rows = table("setting", "from", "value", words_last=True)
    for one in found:
        rows.add_row(one.name, one.source.value, "-" if one.value is None else str(one.value))
    rows.print()
    print_line("")
    of_pair = table("pair", dimensions["designation"], words_last=True)
    for key, value in _flat(dimensions, ""):
        if key != "designation":
            of_pair.add_row(key, f"{value:.12g}" if isinstance(value, float) else str(value))
    of_pair.print()


def _flat(values: Mapping[str, object], outside: str) -> Iterator[tuple[str, object]]:
    """Values by their keys, those of tables behind a dot, as ``--dimension`` takes them."""
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{key}.")
        else:
            yield f"{outside}{key}", value
