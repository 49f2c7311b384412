"""``python -m benchmarks.statics``, on a small scale."""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks import statics
from threadstate.statics import _numbers_kernel as nk
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow


def test_all_ways_are_measured_and_agree(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("sys.argv", ["statics", "--states", "8", "--compared", "2", "--json"])
    statics.main()
    found = json.loads(capsys.readouterr().out)
    assert [one["states"] for one in found["contestants"]] == [8, 2, 2, 2]
    assert found["contestants"][1]["worst"] < statics.AGREE
    assert found["disagreements"] == []


def test_pyramids_within_the_cones_need_at_most_a_little_more_friction() -> None:
    some = statics.scenes(quarter_twenty_unc(), 6)
    holds = statics.closed_forms(some)[:, nk.N_HOLD + 1]
    for scene, hold in zip(some, holds, strict=True):
        if hold < statics.MOST_MU:
            friction = statics.halved(statics.by_nnls, scene)
            assert hold * (1.0 - 1e-6) <= friction <= hold / np.cos(np.pi / statics.SIDES) * (1.0 + 1e-6)
            assert friction == pytest.approx(statics.halved(statics.by_linprog, scene), rel=1e-5)
