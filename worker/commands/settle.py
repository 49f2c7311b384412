"""``threadstate settle``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from threadstate.errors import InvalidValueError
from worker.commands.solve import wanted_poses
from worker.options import DeviceFile, Dimensions, Json, PairName, Phase, Pitch, Poses, Roll, UnitName, number_option
from worker.output import print_json

if TYPE_CHECKING:
    from threadstate.device.model import Device

BATCH = 64
"""How many poses are settled before their answers are printed."""


def settle(
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    poses: Poses = None,
    device: DeviceFile = None,
    mu: Annotated[
        float, number_option("--mu", metavar="M", help="Coefficient of friction of all contacts, 0 to 1.")
    ] = 0.0,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Say where a bolt comes to rest that a compliant device holds at a pose and pushes into the nut.

    With --json, one object a line in the order of the file.

    \b
    Examples:
      threadstate settle --roll 4 --pitch -3 --phase 185
      threadstate settle --roll 0 --pitch 3 --phase 250 --json
      threadstate settle --roll 1 --pitch -2 --phase 10 --device examples/device.toml --unit mm --json
      threadstate settle --poses poses.csv --json
    """
    wanted = wanted_poses(roll, pitch, phase, poses)

    from threadstate.device.document import settled_document
    from threadstate.device.settle import settle_poses
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_settled

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    held = read_device(device) if device is not None else None
    for start in range(0, len(wanted), BATCH):
        for state in settle_poses(threads, wanted[start : start + BATCH], held, mu=mu):
            document = settled_document(state, shown, factor)
            if as_json:
                print_json(document)
            else:
                print_settled(document)


def read_device(path: Path) -> Device:
    """The device of a file: JSON where its name ends in .json, else TOML.

    Raises:
        InvalidValueError: the file cannot be read, or is not a valid device; file and key are named.
    """
    from threadstate.device.document import device_from_document
    from worker.pairs.document import read_toml

    values = _read_json(path) if path.suffix == ".json" else read_toml(path)
    try:
        return device_from_document(values)
    except InvalidValueError as error:
        raise InvalidValueError(f"{path}: {error.name}", error.value, error.valid) from None


def _read_json(path: Path) -> dict[str, Any]:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidValueError("file", str(path), f"a file that can be read ({error.strerror})") from None
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InvalidValueError("file", str(path), f"JSON ({error})") from None
    if not isinstance(values, dict):
        raise InvalidValueError("file", str(path), "a JSON object")
    return values
