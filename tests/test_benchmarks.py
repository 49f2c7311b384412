from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import benchmarks.rebuild
from benchmarks.rebuild import Floor, Part, Rebuilt, profile
from benchmarks.report import Pace, Report, print_tables
from benchmarks.request_times import RequestTimes
from benchmarks.rivalry import TUNNELLED_INCH, Rival
from benchmarks.sample import sample_poses
from benchmarks.work import Work, work_of
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

SMALL = ["--poses", "20", "--compared", "1", "--tilt-max", "0", "--phase-step", "120"]


@pytest.fixture(scope="module")
def report(repository_root: Path) -> dict[str, Any]:
    """What ``make bench`` finds, on a small scale."""
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks", "--json", *SMALL],
        cwd=repository_root,
        check=True,
        capture_output=True,
        text=True,
    )
    found: dict[str, Any] = json.loads(run.stdout)
    return found


def test_sample_is_half_on_the_grid_and_the_same_whatever_its_size() -> None:
    poses = sample_poses(200)
    grid = {pose for index in range(Grid().orientation_count) for pose in Grid().poses(index)}
    assert [tuple(pose) in grid for pose in poses.tolist()] == [True, False] * 100
    assert np.abs(poses[:, :2]).max() <= 4.0
    assert np.array_equal(sample_poses(7), poses[:7])


def test_every_pose_is_counted_once_on_one_core_and_on_two(report: dict[str, Any]) -> None:
    assert [pace["processes"] for pace in report["paces"]] == [1, 2]
    assert all(pace["poses"] + report["declined"] == report["sampled"] == 20 for pace in report["paces"])


def test_boxes_are_counted() -> None:
    work = work_of(quarter_twenty_unc(), sample_poses(80))
    assert 0 < work.without_third < work.poses <= 80
    assert 50.0 < work.boxes < work.boxes_without_third
    assert min(work.following_us, work.solving_us) > 0.0


def test_meshes_come_to_the_exact_heights(report: dict[str, Any]) -> None:
    assert report["compared"] == 1
    assert len(report["rivals"]) == 4
    for rival in report["rivals"]:
        # Fine meshes differ from the surfaces by up to 7e-5 in near a jump (method, section 6).
        assert 0.0 < rival["median_difference"] <= abs(rival["largest_difference"]) < 7e-5 < TUNNELLED_INCH
        assert rival["tunnelled"] == 0
        assert rival["ratio"] == pytest.approx(report["compared_poses_per_second"] / rival["poses_per_second"])


def test_whole_libraries_are_made_and_every_part_is_timed(report: dict[str, Any]) -> None:
    assert [(one["processes"], one["states"]) for one in report["rebuilds"]] == [(1, 3), (2, 3)]
    assert len({part["name"] for part in report["parts"]}) == 12
    assert report["orientations"] == 1
    assert report["compile_seconds"] is None


def test_kernels_of_tilted_poses_are_timed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # The times of processes are in the report, whose level poses no kernel solves.
    monkeypatch.setattr(benchmarks.rebuild, "_process_seconds", lambda _code: 0.0)
    parts = profile(tmp_path, quarter_twenty_unc(), Grid(3.0, 3.0, 120.0))
    for work in ("solve", "histories"):
        seconds = [part.seconds for part in parts if part.name.startswith(work)]
        assert len(seconds) == 2
        assert min(seconds) > 0.0


def test_every_kind_of_request_is_answered(report: dict[str, Any]) -> None:
    assert len({one["name"] for one in report["requests"]}) == 17
    assert all(0.0 < one["median_ms"] <= one["longest_ms"] for one in report["requests"])


def test_tables_show_what_was_found(capsys: pytest.CaptureFixture[str]) -> None:
    print_tables(
        Report(
            sampled=61,
            declined=1,
            paces=[Pace(1, 60, 0.5), Pace(2, 60, 0.25)],
            work=Work(50, 570.4, 4, 2600.0, 240.0, 12.0),
            compared=7,
            compared_poses_per_second=110.0,
            first_contacts_per_second=880.0,
            rivals=[Rival("march", 55.0, 2.0, 5e-7, -0.012, (1.0, -2.0, 357.5), 3)],
            rebuilds=[Rebuilt(2, 27, 1.5, 4_000_000)],
            parts=[
                Part("solve: kernels", "computing", 0.5),
                Part("histories: kernels", "computing", 1.0),
                Part("rows", "computing", 2.5),
            ],
            floor=Floor(0.75, 0.5),
            requests=[RequestTimes("intervals", 210.0, 3.25, 12.0)],
            orientations=9,
            compile_seconds=61.25,
        )
    )
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    for shown in (
        "Exact: all three contacts of 60 poses; 1 more are declined",
        "1 120 0.50",
        "2 240 0.25",
        "exact, all three contacts 110",
        "exact, first contact 880",
        "march 55 2.0 x 16 x 5.0e-07 -1.2e-02 1.00, -2.00, 357.50 3",
        "2 27 1.50 4.0",
        "rows computing 2.50 62.5%",
        "Histories: 9.00/s on one core, beyond the states of the library, in 2.0 times the time of these.",
        "Compilation of what the service needs: 61.2 s.",
        "all 4.00",
        "intervals 210.0 3.2 12.0",
    ):
        assert shown in lines
    work = "Boxes a pose: 570 of 50 tilted ones, 2600 of the 4 without a third contact. A pose takes 240 us, to verify"
    assert f"{work} its contacts where they are known 12.0 us: 20 times this floor." in " ".join(lines)
    assert "kernels alone on 2 cores 0.75 s; 4 MB written plainly to this disk 0.50 s" in lines[-1]
