"""A whole library as a frame: which first contacts lead to a state that holds, and the drop to the third.

Stands on pandas, and asks the service for Parquet.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from threadstate.client import Client
from threadstate.errors import ThreadstateError


def main(library: str) -> None:
    """Print the share of stable states and the median drop, by the regions of the first contact."""
    try:
        import pandas
    except ImportError:
        sys.exit("pandas is not installed: pip install pandas")
    with Client() as client, tempfile.TemporaryDirectory() as folder:
        found = client.library(library)
        states = pandas.read_parquet(client.export("states", Path(folder) / "states.parquet", library=found.id))
    states["stable"] = states["class"] == "stable_three_point"
    by_contact = states.groupby(["contact_1_bolt_region", "contact_1_nut_region"])
    summary = by_contact.agg(states=("stable", "size"), stable=("stable", "mean"), drop=("drop", "median"))
    print(f"library {found.id}: {found.designation}, {len(states)} states, lengths in {found.unit}")
    print(summary.sort_values("states", ascending=False).to_string(formatters={"stable": "{:.1%}".format}))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", default="latest", help="its number, its designation, or latest")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
