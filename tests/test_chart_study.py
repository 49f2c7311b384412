"""The study of speed against accuracy: its statistics, its classification, and a very small run of it."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from studies.chart import coal_engine, exact
from studies.chart.contestant import (
    DEFAULT,
    FULL,
    LIMITED,
    ByMesh,
    Contestant,
    Engine,
    Exactly,
    Scale,
    Series,
    contestants,
)
from studies.chart.drawing import DOCS, STYLES, drawing, points
from studies.chart.errors import (
    FailureMode,
    failure_mode,
    height_error,
    is_clear,
    point_error,
    same_components,
    same_contacts,
    score,
    share,
    spread,
    turn_error,
)
from studies.chart.findings import agreement, better_in_something, document, front, poses_both_faster_and_nearer, ratios
from studies.chart.measure import Run, run
from studies.chart.page import page
from studies.chart.study import Study, limit_of_none, measured_study, true_states, work
from threadstate.contact import _initial_box_kernel as initial_box
from threadstate.mesh.collision import Collider
from threadstate.mesh.frames import fixed_from_bolt
from threadstate.mesh.options import MeshOptions, Scene
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene import scene_part
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Part

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
POSE = (1.0, -2.0, 10.0)
SMALL = Scale(poses=1, compared=1, extrapolated=1, presets=(Preset.COARSE,), bracketings=(), chords=(1e-2, 5e-3))
SEGMENT, REACH = 1e-5, 1e-6


@pytest.fixture(scope="module")
def study() -> Study:
    """A study of one pose and one tessellation; it advances by as much as it announces."""
    advanced: list[int] = []
    found = measured_study(SMALL, 2, advanced.append)
    assert sum(advanced) == work(SMALL)
    return found


@pytest.fixture(scope="module")
def true() -> ContactState:
    """Three contacts, none of them a patch."""
    return solve_pose(PAIR, *POSE, LIMITED)


def moved(state: ContactState, stage: int, by: float) -> ContactState:
    def at(contact: Contact) -> Contact:
        x, y, z = contact.point
        return replace(contact, point=(x + by, y, z)) if contact.stage == stage else contact

    return replace(state, contacts=tuple(map(at, state.contacts)))


def lowered(state: ContactState, by: float) -> ContactState:
    first, *others = state.poses
    x, y, z = first.translation
    return replace(state, poses=(replace(first, translation=(x, y, z - by)), *others))


def test_the_front_is_what_nothing_beats_in_both() -> None:
    points = [(1.0, 9.0), (2.0, 5.0), (3.0, 5.0), (2.0, 6.0), (4.0, 1.0), (5.0, 2.0), (4.0, 1.0)]
    assert front(points) == [0, 1, 4, 6]
    assert front([(1.0, 1.0), (2.0, 2.0)]) == [0]
    assert front([]) == []
    rng = np.random.default_rng(3)
    cloud = [tuple(row) for row in rng.uniform(size=(60, 2)).tolist()]
    beaten = [any(a[0] <= p[0] and a[1] <= p[1] and a != p for a in cloud) for p in cloud]
    assert sorted(front(cloud)) == [k for k, lost in enumerate(beaten) if not lost]


def test_spreads_leave_out_what_is_no_number() -> None:
    found = spread([3.0, math.nan, 1.0, 2.0])
    assert (found.median, found.largest) == (2.0, 3.0)
    assert found.p95 == pytest.approx(2.9)
    assert math.isnan(spread([]).median)
    assert share([True, False, True, True]) == 0.75
    assert math.isnan(share([]))


def test_errors_are_differences_from_the_truth(true: ContactState) -> None:
    assert height_error(lowered(true, 2e-6), true) == pytest.approx(2e-6, rel=1e-6)
    assert point_error(moved(true, 2, 1e-4), true) == pytest.approx(1e-4)
    assert true.mu_deg is not None
    assert turn_error(replace(true, mu_deg=true.mu_deg + 0.25, lambda_deg=None), true) == pytest.approx(0.25)
    assert math.isnan(turn_error(replace(true, mu_deg=None, lambda_deg=None), true))
    assert same_contacts(moved(true, 2, 1e-4), true)
    assert not same_contacts(replace(true, flags=(Flag.TIE,)), true)
    assert not same_contacts(replace(true, contacts=true.contacts[:2]), true)


def test_a_score_counts_what_was_refused(true: ContactState) -> None:
    other = Run(DEFAULT, (lowered(true, 1e-5), None), (1e-3, 3e-3), 0.0, 0, 0.0, 0.0)
    found = score(other, [true, true])
    assert (found.answered, found.asked) == (1, 2)
    assert found.height.largest == pytest.approx(1e-5)
    assert found.seconds.median == pytest.approx(2e-3)
    assert found.same_class == found.same_contacts == 1.0


def mode(one: ContactState, true: ContactState) -> FailureMode | None:
    return failure_mode(one, true, SEGMENT, REACH, PAIR.thread_pitch)


def test_every_failure_has_its_rule(true: ContactState) -> None:
    assert mode(true, true) is None
    assert mode(lowered(moved(true, 2, 0.1), 1e-3), true) is FailureMode.TUNNELLED
    assert true.mu_deg is not None
    assert true.lambda_deg is not None
    assert mode(moved(replace(true, mu_deg=true.mu_deg + 1.0), 3, 0.05), true) is FailureMode.MISSED
    assert mode(moved(replace(true, mu_deg=true.mu_deg - 1.0), 3, 0.05), true) is FailureMode.EARLY_FACETS
    assert mode(replace(true, mu_deg=None, contacts=true.contacts[:2]), true) is FailureMode.MISSED
    assert mode(moved(true, 3, 0.05), true) is FailureMode.TIE
    second = true.contacts[1]
    near = replace(second, stage=3, point=(second.point[0] + SEGMENT, *second.point[1:]))
    beside = replace(true, contacts=(*true.contacts[:2], near))
    assert mode(true, beside) is FailureMode.GROWN_TOGETHER
    other = replace(true.contacts[2], features=FeaturePair.BASE_EDGE)
    renamed = replace(true, contacts=(*true.contacts[:2], other))
    assert mode(renamed, true) is FailureMode.UNEXPLAINED
    narrow = replace(true, contacts=(*true.contacts[:2], replace(true.contacts[2], bolt_margin=0.5 * SEGMENT)))
    assert mode(renamed, narrow) is FailureMode.REGION_BOUNDARY
    twice = replace(true, contacts=(*true.contacts, moved(true, 3, 0.005).contacts[2]), flags=(Flag.TIE,))
    assert mode(twice, true) is FailureMode.ONE_STEP
    flush = replace(true, contacts=true.contacts[:2], flags=(Flag.FLUSH,))
    assert mode(flush, true) is FailureMode.NEARLY_LEVEL
    threads = replace(
        true, contacts=(*true.contacts[:2], replace(true.contacts[2], features=FeaturePair.THREAD_THREAD))
    )
    assert mode(true, threads) is FailureMode.THREAD_ON_THREAD


def test_what_a_mesh_can_tell_apart_is_clear(true: ContactState) -> None:
    margins = [margin for contact in true.contacts for margin in (contact.bolt_margin, contact.nut_margin)]
    assert is_clear(true, 0.9 * min(margins))
    assert not is_clear(true, 1.1 * min(margins))
    assert not is_clear(replace(true, flags=(Flag.GRAZING,)), 1e-9)
    assert same_components(true, true, PAIR.thread_pitch)
    assert not same_components(moved(true, 3, 0.02), true, PAIR.thread_pitch)


def test_extrapolation_finds_what_lines_begin_with() -> None:
    chords = np.array(FULL.chords)
    heights = 0.3 + np.outer(chords, [2.0, -1.0]) + [0.0, 0.4]
    assert limit_of_none(chords, heights) == pytest.approx([0.3, 0.7], abs=1e-12)


def test_contestants_differ_and_the_finest_take_the_most() -> None:
    found = contestants(FULL)
    assert found[0] == DEFAULT
    assert len({(one.series, one.label) for one in found}) == len(found)
    assert {one.series for one in found} == set(Series) == set(STYLES)
    assert len([one for one in found if one.series is Series.EDGES]) == 3 * len(Preset)
    assert len(found) > 45


def test_the_tightest_search_decides_half_of_the_poses_on_the_grid() -> None:
    found = true_states(PAIR, 6)
    assert len(found) == 6
    on_grid = [all(angle == round(angle) for angle in pose) for pose, _ in found]
    assert sum(on_grid) == 3
    for pose, state in found:
        assert state.state_class is solve_pose(PAIR, *pose, LIMITED).state_class


def test_coal_finds_the_pairs_that_fcl_finds() -> None:
    bolt, nut = (scene_part(PAIR, part, Preset.COARSE.tessellation, Scene.EDGES) for part in Part)
    engines = [engine(bolt, nut) for engine in (Collider, coal_engine.CoalEngine)]
    apart, deep = (fixed_from_bolt(0.07, 0.0, 3.2, [0.0, 0.0, height]) for height in (0.02, 0.002))
    distances = [engine.distance(apart) for engine in engines]
    assert distances[0] == pytest.approx(distances[1], abs=1e-9)
    pairs = [{tuple(pair) for pair in engine.pairs(deep).tolist()} for engine in engines]
    assert len(pairs[0]) > 50
    assert len(pairs[0] ^ pairs[1]) < 0.02 * len(pairs[0])
    assert [engine.collides(apart) for engine in engines] == [False, False]
    assert [engine.collides(deep) for engine in engines] == [True, True]
    options = MeshOptions(Preset.COARSE.tessellation, scene=Scene.EDGES)
    states = [
        run(Contestant(Series.COAL, "coarse", ByMesh(options, engine), LIMITED), PAIR, [(0.0, 3.0, 250.0)]).states[0]
        for engine in Engine
    ]
    assert states[0] is not None
    assert states[1] is not None
    assert states[1].poses[0].translation[2] == pytest.approx(states[0].poses[0].translation[2], abs=2e-6)


def test_another_number_of_boxes_is_for_kernels_not_compiled_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(initial_box, "INITIAL_BOXES", initial_box.INITIAL_BOXES)
    exact.use_boxes(48)
    assert initial_box.INITIAL_BOXES == 48


def test_the_proved_state_is_the_state(true: ContactState) -> None:
    proved = exact.proved_state(PAIR, POSE, LIMITED)
    assert proved.contacts == true.contacts
    found = run(replace(DEFAULT, way=Exactly(proved=True)), PAIR, [POSE])
    assert found.states[0] is not None
    assert height_error(found.states[0], true) < 1e-15
    assert found.seconds[0] > 0.0


def test_a_study_finds_the_exact_method_ahead(study: Study) -> None:
    assert {one.run.contestant.series for one in study.measured} == set(Series)
    assert all(one.score.asked == 1 for one in study.measured)
    assert study.measured[0].score.same_contacts == 1.0
    assert better_in_something(study) == []
    assert poses_both_faster_and_nearer(study) == 0
    (loosest, *_) = ratios(study, (Series.CURVES,))
    assert 1.0 < loosest.low <= loosest.median <= loosest.high
    compared = agreement(study)
    assert compared.asked == 1
    assert compared.height.largest < 5e-4


def test_page_and_numbers_say_what_was_measured(study: Study) -> None:
    words, numbers = page(study), json.loads(document(study))
    assert len(numbers["contestants"]) == len(study.measured)
    assert all(one["series"] in words for one in numbers["contestants"])
    assert f"{len(study.measured) - 5} contestants that sample" in " ".join(words.split())
    assert [cost["scene"] for cost in numbers["scenes"]] == list(Scene)
    assert numbers["contestants"][0]["seconds"]["median"] == study.measured[0].score.seconds.median


def test_the_picture_shows_every_contestant(study: Study) -> None:
    numbers = document(study)
    shown = list(points(json.loads(numbers)))
    assert [(point.series, point.seconds) for point in shown] == [
        (one.run.contestant.series, one.score.seconds.median) for one in study.measured
    ]
    lines = {series: sum(point.on_line for point in shown if point.series is series) for series in Series}
    assert lines == {series: 0 if series is Series.EXACT else 1 for series in Series}
    picture = drawing(numbers)
    assert picture == drawing(numbers)
    root = ET.fromstring(picture)
    texts = ["".join(element.itertext()) for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert all(texts.count(name) == 1 for name, _, _ in STYLES.values())
    marks = list(root.iter("{http://www.w3.org/2000/svg}use"))
    sampled = sum(point.series is not Series.EXACT for point in shown)
    colours = [colour for _, _, colour in STYLES.values()]
    drawn = [mark for mark in marks if any(colour in mark.get("style", "") for colour in colours)]
    # In the first panel all, in two those that sample, and each series in the legend.
    assert len(drawn) == len(shown) + 2 * sampled + len(Series)


def test_the_stored_picture_is_that_of_the_stored_numbers() -> None:
    assert (DOCS / "speed-accuracy.svg").read_text() == drawing((DOCS / "speed-accuracy.json").read_text())


def test_what_is_no_number_is_not_drawn_on_the_front() -> None:
    numbers = json.loads((DOCS / "speed-accuracy.json").read_text())
    numbers["contestants"][-1]["turn"]["p95"] = None
    assert math.isnan(list(points(numbers))[-1].turn_deg)
    ET.fromstring(drawing(json.dumps(numbers)))
