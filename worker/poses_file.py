"""Poses from a CSV file with the header ``roll,pitch,phase``."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from pathlib import Path

from threadstate.errors import InvalidValueError
from threadstate.numbers import number, number_text
from threadstate.state.options import TILT_LIMIT_DEG

HEADER = ["roll", "pitch", "phase"]

PosesDeg = list[tuple[float, float, float]]


def read_poses(path: Path) -> PosesDeg:
    """(roll, pitch, phase) in degrees of every line, in the file's order; blank lines are skipped.

    Raises:
        InvalidValueError: the file cannot be read, its header is another one, or a line has something that is not
            three numbers, a tilt beyond 10 deg or an infinite phase; the line is named. No pose is solved then.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            return _poses(file)
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidValueError("poses", str(path), f"a readable CSV file ({error})") from None


def _poses(lines: Iterable[str]) -> PosesDeg:
    reader = csv.reader(lines)
    header = [name.strip() for name in next(reader, [])]
    if header != HEADER:
        raise InvalidValueError("header of the poses", ",".join(header), ",".join(HEADER))
    poses: PosesDeg = []
    for fields in reader:
        if not fields:
            continue
        if len(fields) != len(HEADER):
            raise InvalidValueError(f"line {reader.line_num} of the poses", ",".join(fields), "three numbers")
        where = f"in line {reader.line_num} of the poses"
        roll = _angle(fields[0], f"roll {where}", TILT_LIMIT_DEG)
        pitch = _angle(fields[1], f"pitch {where}", TILT_LIMIT_DEG)
        poses.append((roll, pitch, _angle(fields[2], f"phase {where}", math.inf)))
    return poses


def _angle(text: str, name: str, limit_deg: float) -> float:
    try:
        angle = number(text.strip(" \t"))
    except ValueError:
        angle = math.nan
    if not abs(angle) <= limit_deg:
        limits = f"{number_text(-limit_deg)} to {number_text(limit_deg)} deg"
        valid = "any finite number of degrees" if math.isinf(limit_deg) else limits
        raise InvalidValueError(name, text, valid)
    return angle
