"""Settles a held bolt in MuJoCo, and turns it: run by benchmarks.settle_peer in an environment that has mujoco alone.

Reads a JSON object (meshes, device, cases) from its input, writes one JSON object a case. Lengths are over the nominal
radius and forces over the push, so that all is of the order of 1.
"""

from __future__ import annotations

import json
import math
import sys
import time
from typing import Any

import mujoco
import numpy as np

TIME_STEP, RAMP, END = 0.002, 2.0, 8.0
"""Of the simulation; the push grows to its whole until RAMP."""
CONTACT = 'condim="1" solref="0.01 1" solimp="0.95 0.99 0.0001"'
"""Frictionless, critically damped within 5 steps, 1e-4 radii deep."""
LIFT = 5e-4
"""The bolt starts so far above its first contact."""


def numbers(values: Any) -> str:
    """Numbers as an attribute."""
    return " ".join(f"{value:.9g}" for value in np.ravel(values))


def model(meshes: dict[str, Any], device: dict[str, float], command: list[list[float]], height: float) -> Any:
    """Bolt and nut as signed distances of their meshes; the device is three slides and a ball joint with springs.

    The nut can be turned: a device whose springs are alike all around, and whose tilt goes round with the phase, stays
    as it is in the frame of its phase, in which the nut turns the other way.
    """
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ravel(command))
    assets = "".join(
        f'<mesh name="{name}" inertia="shell" vertex="{numbers(mesh["vertices"])}" face="{numbers(mesh["faces"])}"/>'
        for name, mesh in meshes.items()
    )
    slides = "".join(
        f'<joint type="slide" axis="{axis}" stiffness="{stiffness}" damping="{device["damping"]}"/>'
        for axis, stiffness in (("1 0 0", device["k_lateral"]), ("0 1 0", device["k_lateral"]), ("0 0 1", 0.0))
    )
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="{TIME_STEP}" gravity="0 0 0" integrator="implicitfast"/>
      <asset>{assets}</asset>
      <worldbody>
        <body name="nut" mocap="true"><geom type="sdf" mesh="nut" {CONTACT}/></body>
        <body name="hand" pos="0 0 {height + LIFT}">{slides}<inertial pos="0 0 0" mass="0.1" diaginertia="1 1 1"/>
          <body name="bolt" quat="{numbers(turn)}">
            <joint type="ball" stiffness="{device["k_tilt"]}" damping="{device["damping"]}"/>
            <inertial pos="0 0 0" mass="0.5" diaginertia="0.2 0.2 0.2"/>
            <geom type="sdf" mesh="bolt" {CONTACT}/>
          </body>
        </body>
      </worldbody>
    </mujoco>""")


def about_z(angle: float) -> Any:
    """The turn about z by an angle."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def settled(meshes: dict[str, Any], device: dict[str, float], case: dict[str, Any]) -> dict[str, Any]:
    """The pose of the bolt in the nut at the end, its speed there, and processor seconds without building the model.

    After it has settled it is turned by the ``legs`` of the case (degrees, positive counter-clockwise), at ``rate``
    degrees a unit of time. ``below_deg`` is how far it had been turned when its origin came below the case's ``below``
    and stayed there; None where it did not.
    """
    built = model(meshes, device, case["command"], case["height"])
    data = mujoco.MjData(built)
    bolt = built.body("bolt").id
    start = time.process_time()
    steps = 0
    while data.time < END:
        data.qfrc_applied[2] = -min(1.0, data.time / RAMP)
        mujoco.mj_step(built, data)
        steps += 1
    phase_deg, below_deg = 0.0, None
    for leg_deg in case.get("legs", ()):
        count = max(1, math.ceil(abs(leg_deg) / (case["rate"] * TIME_STEP)))
        for _ in range(count):
            phase_deg += leg_deg / count
            half = math.radians(-phase_deg) / 2.0
            data.mocap_quat[0] = (math.cos(half), 0.0, 0.0, math.sin(half))
            mujoco.mj_step(built, data)
            if data.xpos[bolt][2] >= case.get("below", math.inf):
                below_deg = None
            elif below_deg is None:
                below_deg = phase_deg
        steps += count
    turn = about_z(math.radians(phase_deg))
    return {
        "seconds": time.process_time() - start,
        "steps": steps,
        "translation": (turn @ data.xpos[bolt]).tolist(),
        "rotation": (turn @ data.xmat[bolt].reshape(3, 3)).tolist(),
        "speed": float(np.abs(data.qvel).max()),
        "below_deg": below_deg,
    }


def main() -> None:
    """Settle each case."""
    asked = json.load(sys.stdin)
    for case in asked["cases"]:
        print(json.dumps(settled(asked["meshes"], asked["device"], case)), flush=True)


if __name__ == "__main__":
    main()
