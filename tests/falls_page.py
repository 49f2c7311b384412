"""The tables of docs/windows.md, which every other place that names a fall is compared with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

Tilt = tuple[int, int]


@dataclass(frozen=True)
class ShownFalls:
    """An orientation's row, as it is written; what it does not have is empty."""

    steepest: str
    steepest_from: str
    snap_from: str
    snap_to: str
    fall: str
    jump: str
    jump_at: str

    @property
    def snaps(self) -> bool:
        """Whether a snap is shown."""
        return self.fall != ""


def text_of(repository_root: Path) -> str:
    """The page."""
    return (repository_root / "docs" / "windows.md").read_text()


def table(page: str, number: int) -> list[list[str]]:
    """The cells of a table, without its head; the first has number 0."""
    tables = [block.splitlines()[2:] for block in page.split("\n\n") if block.startswith("|")]
    return [[cell.strip() for cell in line[1:-1].split("|")] for line in tables[number]]


def falls_shown(repository_root: Path) -> Mapping[Tilt, ShownFalls]:
    """The first table, by roll and pitch in degrees."""
    return {(int(roll), int(pitch)): ShownFalls(*cells) for roll, pitch, *cells in table(text_of(repository_root), 0)}
