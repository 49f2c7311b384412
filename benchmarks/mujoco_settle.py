"""Settles a held bolt in MuJoCo: run by benchmarks.settle_peer in an environment of its own, which has mujoco alone.

Reads a JSON object (meshes, device, cases) from its input, writes one JSON object a case. Lengths are over the nominal
radius and forces over the push, so that all is of the order of 1.
"""

from __future__ import annotations

import json
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
    """Bolt and nut as signed distances of their meshes; the device is three slides and a ball joint with springs."""
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
        <geom type="sdf" mesh="nut" {CONTACT}/>
        <body name="hand" pos="0 0 {height + LIFT}">{slides}<inertial pos="0 0 0" mass="0.1" diaginertia="1 1 1"/>
          <body name="bolt" quat="{numbers(turn)}">
            <joint type="ball" stiffness="{device["k_tilt"]}" damping="{device["damping"]}"/>
            <inertial pos="0 0 0" mass="0.5" diaginertia="0.2 0.2 0.2"/>
            <geom type="sdf" mesh="bolt" {CONTACT}/>
          </body>
        </body>
      </worldbody>
    </mujoco>""")


def settled(meshes: dict[str, Any], device: dict[str, float], case: dict[str, Any]) -> dict[str, Any]:
    """The pose of the bolt at the end, its speed there, and processor seconds without building the model."""
    built = model(meshes, device, case["command"], case["height"])
    data = mujoco.MjData(built)
    bolt = built.body("bolt").id
    start = time.process_time()
    steps = 0
    while data.time < END:
        data.qfrc_applied[2] = -min(1.0, data.time / RAMP)
        mujoco.mj_step(built, data)
        steps += 1
    return {
        "seconds": time.process_time() - start,
        "steps": steps,
        "translation": data.xpos[bolt].tolist(),
        "rotation": data.xmat[bolt].reshape(3, 3).tolist(),
        "speed": float(np.abs(data.qvel).max()),
    }


def main() -> None:
    """Settle each case."""
    asked = json.load(sys.stdin)
    for case in asked["cases"]:
        print(json.dumps(settled(asked["meshes"], asked["device"], case)), flush=True)


if __name__ == "__main__":
    main()
