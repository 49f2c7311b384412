"""Lists and percentiles of the page of paths."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

MOST_LISTED = 40


def percentiles(values: Sequence[float]) -> str:
    """The median, the 90th percentile and the largest of some values; nothing where there are none."""
    return ", ".join(f"{value:.1e}" for value in np.percentile(values, (50, 90, 100))) if values else ""


def listed(title: str, names: Sequence[str]) -> str:
    """A section of at most ``MOST_LISTED`` names; nothing where there are none."""
    shown = [f"- {name}" for name in names[:MOST_LISTED]]
    if len(names) > MOST_LISTED:
        shown.append(f"- and {len(names) - MOST_LISTED:,} more")
    return "\n".join(["", f"### {title}", "", *shown, ""]) if names else ""
