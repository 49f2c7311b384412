from __future__ import annotations

import numpy as np
import pytest

from benchmarks.mesh_descent import FASTER, SAFE, Descent, MeshDescent, mesh_first_heights
from oracle.first_height import first_height
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()


@pytest.fixture(scope="module")
def meshes() -> MeshDescent:
    return MeshDescent(PAIR)


@pytest.mark.parametrize("descent", [SAFE, *FASTER])
def test_mesh_heights_agree_with_the_brute_force(meshes: MeshDescent, descent: Descent) -> None:
    poses = np.random.default_rng(20).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (20, 3))
    heights, seconds = mesh_first_heights(meshes, poses, descent)
    exact_inch = [first_height(PAIR, *(float(a) for a in pose)).height for pose in poses]
    assert seconds > 0.0
    # Fine meshes differ from the surfaces by up to 7e-5 in near a jump (method, section 6).
    assert heights == pytest.approx(np.array(exact_inch), abs=7e-5)
    assert np.median(np.abs(heights - exact_inch)) < 2e-6
