from __future__ import annotations

from pathlib import Path

import pytest

from threadstate.errors import InvalidValueError
from worker.poses_file import read_poses


def _file(tmp_path: Path, content: bytes) -> Path:
    path = tmp_path / "poses.csv"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    "content",
    [
        b"roll,pitch,phase\n4,-3,185\n0,1e-3,-720.5\n",
        b"roll,pitch,phase\r\n4,-3,185\r\n0,1e-3,-720.5",
        b"\xef\xbb\xbfroll, pitch, phase\n4, -3, 185\n\n0, 1e-3, -720.5\n",
        b'"roll","pitch","phase"\n"4","-3","185"\n"0","1e-3","-720.5"\n',
    ],
)
def test_poses_come_in_the_order_of_the_file(tmp_path: Path, content: bytes) -> None:
    assert read_poses(_file(tmp_path, content)) == [(4.0, -3.0, 185.0), (0.0, 0.001, -720.5)]


def test_a_file_of_a_header_alone_has_no_poses(tmp_path: Path) -> None:
    assert read_poses(_file(tmp_path, b"roll,pitch,phase\n")) == []


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "header"),
        (b"4,-3,185\n", "header of the poses is '4,-3,185'"),
        (b"phase,roll,pitch\n1,2,3\n", "header"),
        (b"roll,pitch,phase\n1,2,3\n1,2\n", "line 3 .*'1,2'.*three numbers"),
        (b"roll,pitch,phase\n1,2,3,4\n", "line 2"),
        (b"roll,pitch,phase\n1,x,3\n", "pitch in line 2 of the poses is 'x'"),
        (b"roll,pitch,phase\n10.5,0,3\n", "roll in line 2 .*-10 to 10 deg"),
        (b"roll,pitch,phase\n0,-11,3\n", "pitch in line 2 .*-10 to 10 deg"),
        (b"roll,pitch,phase\n0,nan,3\n", "pitch in line 2"),
        (b"roll,pitch,phase\n1_0,0,3\n", "roll in line 2 of the poses is '1_0'"),
        ("roll,pitch,phase\n0,٣,3\n".encode(), "pitch in line 2 of the poses is '٣'"),
        (b"roll,pitch,phase\n0,0,inf\n", "phase in line 2 .*any finite number"),
        (b"roll,pitch,phase\n\xff\xfe\n", "readable CSV"),
    ],
)
def test_a_bad_line_is_named(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        read_poses(_file(tmp_path, content))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match=r"nowhere\.csv.*No such file"):
        read_poses(tmp_path / "nowhere.csv")
