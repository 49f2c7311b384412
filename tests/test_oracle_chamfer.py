"""The brute force of chamfered bolts beside that of flat ones, and beside closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from oracle.chamfer import Samples, chamfered_height
from oracle.first_height import first_height
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

UNC = quarter_twenty_unc()


def poses(count: int, seed: int) -> list[tuple[float, float, float]]:
    rng = np.random.default_rng(seed)
    return [tuple(one) for one in rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (count, 3)).round(3).tolist()]


@pytest.mark.parametrize("pair", [UNC, pair_by_designation("M6 LH 2 starts")], ids=lambda pair: pair.designation)
def test_a_chamfer_that_removes_nothing_gives_the_flat_bolts_heights(pair: Pair) -> None:
    nothing = replace(pair, chamfer=Chamfer(pair.fit.bolt_major_diameter))
    for pose in poses(5, 1):
        expected = first_height(pair, *pose)
        found = chamfered_height(nothing, *pose)
        assert found.height == pytest.approx(expected.height, abs=1e-9 * pair.thread_pitch), pose
        assert {"outline": "edge"}.get(found.bolt, found.bolt) == expected.features.partition("-")[0], pose


def test_a_level_bolt_rests_with_its_cone_on_the_nuts_crest() -> None:
    """Where the cone is as wide as the nut's minor diameter; phase 90 turns it to where the nut's outline is so."""
    for angle in (30.0, 45.0, 60.0):
        pair = replace(UNC, chamfer=Chamfer(0.18, angle))
        expected = -(0.196 - 0.18) / 2.0 * math.tan(math.radians(angle))
        found = chamfered_height(pair, 0.0, 0.0, 90.0)
        assert found.height == pytest.approx(expected, abs=1e-12)
        assert (found.bolt, found.nut) == ("cone", "edge")


def test_denser_samples_find_nothing_higher() -> None:
    pair = replace(UNC, chamfer=Chamfer(0.1844))
    dense = Samples(edge=5760, around=1080, along=90, steps=400)
    for pose in poses(3, 2):
        found = chamfered_height(pair, *pose)
        assert chamfered_height(pair, *pose, dense).height == pytest.approx(found.height, abs=1e-8 * 0.05), pose


def test_less_bolt_is_lower() -> None:
    for pose in poses(8, 3):
        ends = [0.2489, 0.22, 0.19, 0.17]
        heights = [chamfered_height(replace(UNC, chamfer=Chamfer(end)), *pose).height for end in ends]
        assert all(b <= a + 1e-9 for a, b in pairwise(heights)), pose
