"""``make peer`` with a peer that leaves the bolt where it is commanded: what is asked and what is compared."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks import settle_peer
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import PathEventKind
from threadstate.device.document import device_from_document
from threadstate.device.settle import settle_pose
from threadstate.mesh.presets import Preset
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

STILL = """
import json, sys
asked = json.load(sys.stdin)
assert set(asked["meshes"]) == {"bolt", "nut"}
assert abs(asked["device"]["k_lateral"] - 20.0 * 3.175 / 10.0) < 1e-9
assert abs(asked["device"]["k_tilt"] - 500.0 / (10.0 * 3.175)) < 1e-9
for case in asked["cases"]:
    pose = {"rotation": case["command"], "translation": [0.0, 0.0, case["height"]]}
    below = case["legs"][0] if "below" in case else None
    print(json.dumps({"seconds": 2.0, "steps": 1, "speed": 0.0, "below_deg": below, **pose}))
"""


def test_a_peer_that_does_not_move_is_apart_by_the_whole_deviation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    child = tmp_path / "still.py"
    child.write_text(STILL)
    monkeypatch.setattr(settle_peer, "CHILD", child)
    found = settle_peer.compared(Path(sys.executable), 3, Preset.COARSE)
    assert len(found) == 3
    pair, device = quarter_twenty_unc(), device_from_document(settle_peer.DEVICE)
    r = pair.nominal_diameter / 2.0
    for one in found:
        state = settle_pose(pair, *one.pose_deg, device)
        assert one.apart == pytest.approx(np.linalg.norm(state.shift or ()) / r, rel=1e-9)
        assert one.angle_deg == pytest.approx(np.linalg.norm(state.rotation_deg or ()), rel=1e-6)
        assert abs(one.overlap) < 1e-8
        assert one.peer_ms == 2000.0
    assert "2,000 ms" in settle_peer.page(found, [], Preset.COARSE)


def test_a_peer_that_does_not_turn_is_apart_by_the_whole_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    child = tmp_path / "still.py"
    child.write_text(STILL)
    monkeypatch.setattr(settle_peer, "CHILD", child)
    found = settle_peer.compared_paths(Path(sys.executable), 2, Preset.COARSE, [40.0, 10.0])
    assert [one.rate for one in found] == [40.0, 10.0] * (len(found) // 2)
    pair = quarter_twenty_unc()
    r = pair.nominal_diameter / 2.0
    for one in found:
        path = assemble_pose(pair, *one.pose_deg)
        first, last = path.start, path.points[-1].pose
        assert (one.outcome, one.peer_s) == (path.outcome, 2.0)
        assert one.turned_deg == sum(map(abs, settle_peer.legs_deg(path)))
        assert first.pose is not None
        assert first.shift is not None
        height = first.pose.translation[2] - first.shift[2]
        gone = np.array(last.translation) - np.array([0.0, 0.0, height])
        assert one.apart == pytest.approx(np.linalg.norm(gone) / r, rel=1e-9)
        snaps = any(event.kind is PathEventKind.SNAP for event in path.events)
        assert one.late_deg == (pytest.approx(settle_peer.AFTER_SNAP_DEG) if snaps else None)
    settled = settle_peer.compared(Path(sys.executable), 1, Preset.COARSE)
    words = settle_peer.page(settled, found, Preset.COARSE).split("## Whole paths")[1]
    assert "At 10 deg a unit of its time MuJoCo takes" in words
    assert "its snap comes 20.0 deg after ours" in words
    assert words.count("| engaged |") + words.count("| no snap |") == len(found)
