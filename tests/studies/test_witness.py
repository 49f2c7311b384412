"""The comparison with the witness, on a small scale, and that it finds what is wrong."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from studies.witness import compare as comparison
from studies.witness.compare import AGREE, Bracket, Number, Outcome, compare
from studies.witness.page import page
from studies.witness.scenes import PATCH_EVERY, LoadKind, Scene, scenes
from threadstate.statics import _numbers_kernel as nk
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

COUNT = 2 * PATCH_EVERY


@pytest.fixture(scope="module")
def some() -> list[Scene]:
    return list(islice(scenes(quarter_twenty_unc()), COUNT))


def test_scenes_have_every_kind_of_load_and_patches_among_them(some: list[Scene]) -> None:
    assert {scene.kind for scene in some} == set(LoadKind)
    assert [scene.patch for scene in some].count(True) == 2
    assert all(np.allclose(np.linalg.norm(scene.normals, axis=1), 1.0) for scene in some)


def test_all_numbers_agree_and_are_bracketed(some: list[Scene]) -> None:
    found = [(scene, compare(scene)) for scene in some]
    numbers = [one for _, ones in found for one in ones]
    assert {one.outcome for one in numbers} <= {Outcome.AGREE, Outcome.VERIFIED}
    assert {one.bracket for one in numbers} == {Bracket.HOLDS, None}
    assert [one.number for one in numbers] == list(Number) * COUNT
    text = page(found)
    assert f"of {COUNT} random states" in text
    assert text.rstrip().endswith("None.")


@pytest.mark.parametrize("by", [1e-6, -1e-6])
def test_a_number_that_is_wrong_is_apart_from_the_witness(
    some: list[Scene], monkeypatch: pytest.MonkeyPatch, by: float
) -> None:
    closed_forms = comparison._closed_forms
    scene = next(
        one
        for one in some
        if 0.01 < closed_forms(one)[nk.N_HOLD] < 10.0 and not one.patch and compare(one)[0].outcome is Outcome.AGREE
    )

    def wrong(given: Scene) -> object:
        row = closed_forms(given)
        row[nk.N_HOLD : nk.N_HOLD + 2] = np.tan(np.arctan(row[nk.N_HOLD : nk.N_HOLD + 2]) + by)
        row[nk.N_MARGIN] += by
        return row

    monkeypatch.setattr(comparison, "_closed_forms", wrong)
    hold, wedge, margin = compare(scene)
    assert (hold.outcome, wedge.outcome, margin.outcome) == (Outcome.APART, Outcome.AGREE, Outcome.APART)
    assert hold.apart == pytest.approx(1e-6, abs=AGREE)
    listed = page([(scene, [hold, wedge, margin])])
    assert "| apart |" in listed


def test_pyramids_tell_a_friction_that_is_too_large(some: list[Scene], monkeypatch: pytest.MonkeyPatch) -> None:
    closed_forms = comparison._closed_forms
    scene = next(one for one in some if 0.1 < closed_forms(one)[nk.N_HOLD] < 2.0)

    def wrong(given: Scene) -> object:
        row = closed_forms(given)
        row[nk.N_HOLD : nk.N_HOLD + 2] *= 1.5
        return row

    monkeypatch.setattr(comparison, "_closed_forms", wrong)
    hold, *_ = compare(replace(scene))
    assert (hold.bracket, hold.outcome) == (Bracket.VIOLATED, Outcome.APART)
