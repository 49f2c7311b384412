"""Poses from a CSV file with the header ``roll,pitch,phase``."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from pathlib import Path

from threadstate.errors import InvalidValueError

HEADER = ["roll", "pitch", "phase"]

PosesDeg = list[tuple[float, float, float]]


def read_poses(path: Path) -> PosesDeg:
    """(roll, pitch, phase) in degrees of every line, in the file's order; blank lines are passed over.

    Raises:
        InvalidValueError: the file cannot be read, its header is another one, or a line has something that is not a
            finite number; the line is named.
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
        roll, pitch, phase = (
            _number(text, f"{name} in line {reader.line_num} of the poses")
            for name, text in zip(HEADER, fields, strict=True)
        )
        poses.append((roll, pitch, phase))
    return poses


def _number(text: str, name: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InvalidValueError(name, text, "a finite number of degrees")
    return number
