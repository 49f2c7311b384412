"""What memory held before decides nothing: kernels, interpreted, whose new arrays hold other numbers."""

from __future__ import annotations

import math
import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

INTERPRETED = """
import numpy as np

import threadstate._compile

threadstate._compile.kernel = lambda **options: lambda function: function
make, held = np.empty, 0.0

def new(shape, dtype=float):
    array = make(shape, dtype)
    array.fill(held if array.dtype.kind == "f" else 0)
    return array

np.empty = new
"""

PATHS = """
from threadstate.device.settle import settle_pose
from threadstate.thread.catalogue import quarter_twenty_unc

settled = set()
for held in (0.5, np.inf, np.nan):
    settled.add(settle_pose(quarter_twenty_unc(), ROLL, 0.0, 0.0))
print(len(settled), settled.pop().outcome.value)
"""

LAID = """
from threadstate.device import _friction_held_kernel as held_kernel
from threadstate.device import _slide_kernel as slide_kernel
from threadstate.device.settle import settle_pose
from threadstate.thread.catalogue import quarter_twenty_unc

class Laid(Exception):
    pass

lie_flush, centre_of_pressure = held_kernel.lie_flush, slide_kernel.centre_of_pressure

def pressed_aside(*arguments):
    x, y, force, rest = centre_of_pressure(*arguments)
    return x + ASIDE[0], y + ASIDE[1], force, rest

def lay_once(*arguments):
    raise Laid(*lie_flush(*arguments))

held_kernel.lie_flush, slide_kernel.centre_of_pressure = lay_once, pressed_aside
for held in (0.5, np.inf, np.nan):
    try:
        settle_pose(quarter_twenty_unc(), 0.0, 0.0, 0.0, mu=0.3)
    except Laid as laid:
        print(laid)
"""


def printed(program: str) -> list[str]:
    """The lines that a program prints after kernels have been replaced by what they are made of."""
    ran = subprocess.run([sys.executable, "-c", INTERPRETED + program], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout.splitlines()


@pytest.mark.parametrize("roll_deg", [0.0, 3.0])
def test_a_path_does_not_hang_on_what_memory_held(roll_deg: float) -> None:
    assert printed(PATHS.replace("ROLL", str(roll_deg))) == ["1 settled"]


@pytest.mark.parametrize("aside", [(0.01, 0.02), (-0.03, 0.01), (0.0, -0.02)])
def test_a_bolt_of_whose_patch_nothing_is_left_tips_towards_where_it_is_pressed(aside: tuple[float, float]) -> None:
    first, *others = printed(LAID.replace("ASIDE", str(aside)))
    assert others == [first, first]
    is_laid, direction = first.strip("()").split(", ")
    assert is_laid == "False"
    assert float(direction) == pytest.approx(math.atan2(aside[1], aside[0]), abs=1e-9)
