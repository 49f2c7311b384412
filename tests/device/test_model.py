"""Devices and their documents: what is accepted, what is refused, units."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from threadstate.device.document import device_document, device_from_document
from threadstate.device.model import About, Device, Limits, default_device
from threadstate.errors import InvalidValueError
from threadstate.units import LengthUnit
from worker.commands.settle import read_device

UNIT = np.eye(6).tolist()


def changed(*entries: tuple[int, int, float]) -> list[list[float]]:
    """The unit matrix with other entries."""
    rows: list[list[float]] = np.eye(6).tolist()
    for i, j, value in entries:
        rows[i][j] = value
    return rows


def test_what_a_document_leaves_out_is_as_of_the_default_device(repository_root: Path) -> None:
    assert device_from_document({"unit": "mm"}) == default_device()
    assert read_device(repository_root / "examples" / "device.toml") == default_device()
    inches = device_from_document({"unit": "in"})
    assert inches == default_device().in_unit(LengthUnit.INCH)
    assert inches.stiffness[3][3] == pytest.approx(508.0)
    assert inches.stiffness[0][0] == pytest.approx(500.0 / 25.4)


def test_units_convert_there_and_back() -> None:
    rng = np.random.default_rng(2)
    root = rng.standard_normal((6, 6))
    device = Device(tuple(map(tuple, (root @ root.T).tolist())), 1.5, 7.0, LengthUnit.MILLIMETRE, False, About.BOLT)
    same = device.in_unit(LengthUnit.INCH).in_unit(LengthUnit.MILLIMETRE)
    assert np.allclose(same.stiffness, device.stiffness, rtol=1e-14)
    assert same.centre == pytest.approx(1.5)
    assert (same.push, same.twist_is_rigid) == (7.0, False)
    # The energy is the same, in N in and N mm: angles stay, lengths are over 25.4.
    e = rng.standard_normal(6)
    inch = np.concatenate([e[:3], e[3:] / 25.4])
    there = np.array(device.in_unit(LengthUnit.INCH).stiffness)
    assert inch @ there @ inch * 25.4 == pytest.approx(e @ np.array(device.stiffness) @ e)


def test_all_keys_are_read(tmp_path: Path) -> None:
    path = tmp_path / "device.json"
    path.write_text(
        '{"unit": "in", "k_lateral": 1, "k_axial": 2.5, "k_tilt": 3, "k_twist": 4, "centre": -5, '
        '"push": 6, "ccw_turn": 390, "tilt_limit": 2, "shift_limit": 0.1, "torque_limit": 3}'
    )
    device = read_device(path)
    assert np.array_equal(np.diag(device.stiffness), [3.0, 3.0, 4.0, 1.0, 1.0, 2.5])
    assert (device.centre, device.push, device.twist_is_rigid, device.about) == (-5.0, 6.0, False, About.NUT)
    assert device.ccw_turn_deg == 390.0
    assert device.limits == Limits(2.0, 0.1, 3.0)
    assert astuple(device.in_unit(LengthUnit.MILLIMETRE).limits) == pytest.approx((2.0, 2.54, 76.2))
    full = device_from_document({"unit": "mm", "stiffness": changed((0, 4, 0.5), (4, 0, 0.5)), "about": "bolt"})
    assert full.stiffness[0][4] == 0.5
    assert (full.twist_is_rigid, full.about, full.push) == (False, About.BOLT, 10.0)


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({}, "unit"),
        ({"unit": "m"}, "unit"),
        ({"unit": "mm", "k_lateral": -1.0}, "k_lateral"),
        ({"unit": "mm", "k_lateral": "stiff"}, "k_lateral"),
        ({"unit": "mm", "k_lateral": True}, "k_lateral"),
        ({"unit": "mm", "k_lateral": float("nan")}, "k_lateral"),
        ({"unit": "mm", "k_tilt": 1e13}, "k_tilt"),
        ({"unit": "mm", "k_twist": "soft"}, "k_twist"),
        ({"unit": "mm", "k_twist": -0.5}, "k_twist"),
        ({"unit": "mm", "push": 0.0}, "push"),
        ({"unit": "mm", "push": -3.0}, "push"),
        ({"unit": "mm", "push": float("inf")}, "push"),
        ({"unit": "mm", "centre": float("nan")}, "centre"),
        ({"unit": "mm", "about": "hand"}, "about"),
        ({"unit": "mm", "ccw_turn": 0.5}, "ccw_turn"),
        ({"unit": "mm", "ccw_turn": 450.5}, "ccw_turn"),
        ({"unit": "mm", "ccw_turn": float("nan")}, "ccw_turn"),
        ({"unit": "mm", "tilt_limit": 0.0}, "tilt_limit"),
        ({"unit": "mm", "shift_limit": -1.0}, "shift_limit"),
        ({"unit": "mm", "torque_limit": float("nan")}, "torque_limit"),
        ({"unit": "mm", "spring": 1.0}, "spring"),
        ({"unit": "mm", "stiffness": UNIT[:5]}, "stiffness"),
        ({"unit": "mm", "stiffness": [row[:5] for row in UNIT]}, "stiffness"),
        ({"unit": "mm", "stiffness": changed((1, 4, 0.5))}, "stiffness[4][1]"),
        ({"unit": "mm", "stiffness": changed((1, 1, -1.0))}, "stiffness[1][1]"),
        ({"unit": "mm", "stiffness": changed((0, 4, 2.0), (4, 0, 2.0))}, "stiffness"),
        ({"unit": "mm", "stiffness": changed((1, 1, 0.0), (1, 4, 0.5), (4, 1, 0.5))}, "stiffness[4][1]"),
        ({"unit": "mm", "stiffness": UNIT, "k_twist": "rigid"}, "stiffness[2][2]"),
        ({"unit": "mm", "stiffness": UNIT, "k_tilt": 1.0}, "k_tilt"),
        ({"unit": "mm", "stiffness": UNIT, "k_twist": 1.0}, "k_twist"),
        ({"unit": "mm", "stiffness": [["a"] * 6] * 6}, "stiffness[0][0]"),
    ],
)
def test_a_bad_document_names_the_key_and_the_valid_range(values: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidValueError) as error:
        device_from_document(values)
    assert error.value.name == name
    assert error.value.valid


def test_a_zero_stiffness_is_allowed() -> None:
    rows = changed((2, 2, 0.0), (5, 5, 0.0))
    assert device_from_document({"unit": "mm", "stiffness": rows, "k_twist": "rigid"}).twist_is_rigid


@pytest.mark.parametrize(
    "values",
    [
        {"unit": "mm"},
        {"unit": "in", "k_twist": 3.5, "about": "bolt", "centre": -0.0, "ccw_turn": 390},
        {"unit": "mm", "shift_limit": 2.5, "tilt_limit": 1},
        {"unit": "mm", "stiffness": changed((0, 4, 0.5), (4, 0, 0.5)), "push": 1.0 / 3.0},
        {"unit": "mm", "stiffness": changed((2, 2, 0.0), (0, 0, 2.0)), "k_twist": "rigid"},
    ],
)
def test_the_document_of_a_device_gives_it_back(values: dict[str, Any]) -> None:
    device = device_from_document(values)
    document = device_document(device)
    assert device_from_document(document) == device
    assert device_document(device_from_document(document)) == document
    assert ("stiffness" in document) == ("stiffness" in values)


def test_equal_devices_have_one_document() -> None:
    as_matrix = device_from_document({"unit": "mm", "stiffness": np.diag([5.0, 5.0, 0.0, 2.0, 2.0, 1.0]).tolist()})
    named = device_from_document({"unit": "mm", "k_tilt": 5, "k_twist": 0, "k_lateral": 2, "k_axial": 1})
    assert as_matrix == named
    assert (
        device_document(as_matrix)
        == device_document(named)
        == {
            "unit": "mm",
            "k_lateral": 2.0,
            "k_axial": 1.0,
            "k_tilt": 5.0,
            "k_twist": 0.0,
            "centre": 0.0,
            "push": 10.0,
            "about": "nut",
            "ccw_turn": 360.0,
        }
    )
