"""Several rebuilds in one database at once: each library is whole, and is the one that it is alone."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from harness.databases import Databases
from tests.faults.conftest import Unwatched, published
from tests.stored_histories.history_library import PAIR, content_of
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.state.options import SolveOptions
from worker.rebuild import RebuildResult, rebuild

pytestmark = pytest.mark.slow

GRIDS = [Grid(3.0, 3.0, step) for step in (30.0, 45.0, 60.0)]
EACH = 2


def test_same_and_different_libraries_at_once(databases: Databases) -> None:
    expected = [content_of(grid) for grid in GRIDS]
    with databases.lent() as database:

        def rebuilt(grid: Grid) -> RebuildResult:
            with writing(database) as engine:
                return rebuild(engine, LibraryInputs(PAIR, grid, SolveOptions()), 1, Unwatched())

        rebuilds = [grid for grid in GRIDS for _ in range(EACH)]
        with ThreadPoolExecutor(len(rebuilds)) as threads:
            ended = list(threads.map(rebuilt, rebuilds))
        assert [one.content_sha256 for one in ended] == [content for content in expected for _ in range(EACH)]
        for grid, one, other in zip(GRIDS, ended[::EACH], ended[1::EACH], strict=True):
            assert one.library_id == other.library_id
            assert one.computed + other.computed == grid.pose_count, "each pose is counted once"
        with writing(database) as engine:
            assert sorted(published(engine)) == sorted(expected)
