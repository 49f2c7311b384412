"""A whole library as a frame: which first contacts lead to a state that holds, and how deep they drop.

usage: python examples/library_summary.py    (extras: client, pandas, parquet)
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import pandas

from threadstate.client import Client


def main() -> None:
    """Print the share of stable states and the drop, by the regions of the first contact."""
    with Client() as client, tempfile.TemporaryDirectory() as folder:
        library = client.library()
        states = pandas.read_parquet(client.export("states", Path(folder) / "states.parquet"))
    states["stable"] = states["class"] == "stable_three_point"
    by_contact = states.groupby(["contact_1_bolt_region", "contact_1_nut_region"])
    summary = by_contact.agg(states=("stable", "size"), stable=("stable", "mean"), drop=("drop", "median"))
    print(f"library {library.id}: {library.designation}, {len(states)} states, lengths in {library.unit}")
    print(summary.sort_values("states", ascending=False).to_string(formatters={"stable": "{:.1%}".format}))


if __name__ == "__main__":
    main()
