"""What is there for bolts that are cut flat refuses a chamfered one by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tests.thread.test_chamfer import CHAMFERED, UNC
from threadstate.errors import InvalidValueError
from threadstate.history.build import histories_of
from threadstate.history.height_curve import height_curve
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.mesh.options import MeshOptions
from threadstate.state.solve import SolveOptions, solve_pose
from threadstate.statics.load import Load
from threadstate.statics.rows import statics_rows
from threadstate.statics.scene import scene_of

OPTIONS = SolveOptions()


@pytest.mark.parametrize(
    "ask",
    [
        lambda: solve_pose(CHAMFERED, 1.0, 2.0, 3.0),
        lambda: solve_pose(CHAMFERED, 0.0, 0.0, 0.0),
        lambda: list(histories_of(CHAMFERED, [(1.0, 2.0)], OPTIONS)),
        lambda: height_curve(CHAMFERED, 1.0, 2.0, OPTIONS),
    ],
    ids=["pose", "level", "history", "heights"],
)
def test_the_exact_method_refuses_a_chamfer(ask: Callable[[], object]) -> None:
    with pytest.raises(
        InvalidValueError, match=r"chamfer is 'end diameter 0\.18 in'; valid: none for the exact method"
    ):
        ask()


@pytest.mark.parametrize("mesh", [None, MeshOptions()])
def test_libraries_refuse_a_chamfer(mesh: MeshOptions | None) -> None:
    with pytest.raises(InvalidValueError, match="valid: none for a stored library"):
        LibraryInputs(CHAMFERED, Grid(), OPTIONS, mesh)


def test_statics_refuse_a_chamfer() -> None:
    state = solve_pose(UNC, 1.0, 2.0, 3.0)
    with pytest.raises(InvalidValueError, match="valid: none for statics"):
        scene_of(CHAMFERED, state, Load())
    with pytest.raises(InvalidValueError, match="valid: none for statics"):
        statics_rows(CHAMFERED, np.empty((0, 1)))
