"""Places of overlap that lie close together: found beside each other, remembered, and followed from edge to thread."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact._stage_kernel import EDGE_THREAD, THREAD_EDGE, THREAD_THREAD, new_work
from threadstate.device import _chart_kernel as ck
from threadstate.device import _gap_kernel as gk
from threadstate.device import _place_near_kernel as near
from threadstate.device import _places_kernel as pl
from threadstate.device._certificate_kernel import FREE, overlap
from threadstate.device._settle_kernel import OVERLAP_LIMIT
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
BOLT, NUT = UNC.bolt.packed, UNC.nut.packed
R = UNC.nominal_diameter / 2.0
TOUCHING = 1e-9 * R


def numbers() -> Floats:
    """Of a device that commands the nut's axes."""
    device = np.zeros(ck.DEVICE_SIZE)
    device[ck.D_ROTATION : ck.D_ROTATION + 9] = np.eye(3).ravel()
    device[ck.D_SCALE] = R
    device[ck.D_FINE] = pl.FINE
    return device


def place_of(rotation: Floats, offset: Floats) -> Floats:
    """A pose in numbers, in coordinates that turn about the nut's axes."""
    angle = math.acos((np.trace(rotation) - 1.0) / 2.0)
    vector = np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    place = np.zeros(ck.PLACE_SIZE)
    turn = vector * (angle / (2.0 * math.sin(angle)) if angle > 0.0 else 0.5)
    ck.set_place(np.concatenate((turn, offset)), numbers(), place)
    return place


def found(place: Floats, reach: float, threads: pl.Threads) -> Floats:
    """The places of a search."""
    places = np.zeros((pl.MAX_PLACES + 1, gk.GAP_SIZE))
    count = pl.find_places(reach, place, numbers(), BOLT, NUT, threads, np.zeros(pl.PLACES_WORK), places)
    return places[:count]


WITHIN = {
    "a fillet lies between": (
        THREAD_EDGE,
        (
            (0.9757314448623632, 0.21739295464635103, -0.02623834554492122),
            (-0.21766732202316835, 0.9759897146324782, -0.008063116945454252),
            (0.023855490564384654, 0.01357866715636382, 0.9996231966937287),
        ),
        (-0.000835059093067843, 0.0031954780783076606, -0.0038060654953361323),
    ),
    "phi rises as far as the corner of a crest": (
        EDGE_THREAD,
        (
            (-0.9109029818937728, 0.41262059700673964, 2.242397719525325e-05),
            (-0.41261935333569555, -0.9109001002072816, -0.0025053333504182485),
            (-0.0010133261396762655, -0.0022913681865034258, 0.9999968613960588),
        ),
        (-8.130418341511673e-05, 0.0005423103327403243, -0.021917340861281484),
    ),
    "the ridge begins beside the edge's place": (
        EDGE_THREAD,
        (
            (0.9054544737200818, 0.4243854105972612, -0.00701564626272997),
            (-0.4244157008778651, 0.9054605218788768, -0.0035434682420341646),
            (0.004848594501535047, 0.006185999597942582, 0.9999691117931263),
        ),
        (-0.0025080548190156465, 0.002179033080642574, -0.004861026864618087),
    ),
}
"""Poses at which a contact of an edge goes on within the threads: its features, rotation and translation (in)."""


@pytest.mark.parametrize("case", WITHIN)
def test_a_maximum_within_an_edge_is_found(case: str) -> None:
    """It overlaps by 1e-6 to 4e-6 r, and lies between two azimuths on which the search looks for ridges."""
    pair, rotation, translation = WITHIN[case]
    place = place_of(np.array(rotation), np.array(translation))
    places = found(place, TOUCHING, pl.new_threads(BOLT))
    overlapping = (places[:, gk.G_PAIR] == THREAD_THREAD) & (places[:, gk.G_VALUE] > TOUCHING)
    (within,) = places[overlapping]
    assert 1e-6 * R < within[gk.G_VALUE] < 1e-5 * R
    beside = np.linalg.norm(places[:, gk.G_POINT : gk.G_POINT + 3] - within[gk.G_POINT : gk.G_POINT + 3], axis=1)
    assert ((places[:, gk.G_PAIR] == pair) & (beside < 0.05 * R)).sum() == 1


def test_a_contact_is_followed_across_a_fillet_to_the_maximum_within() -> None:
    """From the nut's edge phi rises by 3e-4 of the way down the flank, and on 0.008 r below it falls."""
    _, rotation, translation = WITHIN["a fillet lies between"]
    place = place_of(np.array(rotation), np.array(translation))
    places = found(place, TOUCHING, pl.new_threads(BOLT))
    (within,) = places[places[:, gk.G_PAIR] == THREAD_THREAD]
    beside = np.linalg.norm(places[:, gk.G_POINT : gk.G_POINT + 3] - within[gk.G_POINT : gk.G_POINT + 3], axis=1)
    (edge,) = places[(places[:, gk.G_PAIR] == THREAD_EDGE) & (beside < 0.02 * R)]
    work = np.zeros(pl.PLACES_WORK)
    assert near.follow_place(edge, place, numbers(), BOLT, NUT, pl.new_threads(BOLT), work)
    assert edge[gk.G_PAIR] == THREAD_THREAD
    assert np.allclose(edge[gk.G_POINT : gk.G_POINT + 3], within[gk.G_POINT : gk.G_POINT + 3], atol=1e-9 * R)


def test_a_contact_that_overlaps_by_round_off_on_a_nearly_straight_arc_is_certified() -> None:
    """By 4e-12 nominal radii (decision 53); 2e-8 deeper, which is more than is allowed, it is not."""
    rotation = np.array(
        [
            [0.999490155356339, -0.002371310601031948, 0.03184032399010419],
            [0.0015077423328999885, 0.9996310884872599, 0.027118511073309603],
            [-0.03189288414080723, -0.027056677841321687, 0.9991250072565353],
        ]
    )
    offset = np.array([-0.00653984623936604, -0.005469860233952158, -0.0006576650959660022])
    said = []
    for deeper in (0.0, 2e-8 * R):
        place = place_of(rotation, offset - np.array([0.0, 0.0, deeper]))
        places = found(place, TOUCHING, pl.new_threads(BOLT))
        assert places[:, gk.G_VALUE].max() > 1e-12 * R
        said.append(overlap(place[0:12], OVERLAP_LIMIT * R, len(places), places, BOLT, NUT, new_work()))
    assert said[0] == FREE
    assert said[1] != FREE


def test_samples_of_both_edges_have_the_lesser_of_g_and_phi() -> None:
    """Of a tilted pose, all round, as at single points of the edges."""
    cos, sin = math.cos(0.05), math.sin(0.05)
    place = place_of(np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]]), np.array([0.01, -0.02, -0.03]))
    threads = pl.new_threads(BOLT)
    pl.set_samples(pl.FINE, BOLT, NUT, threads.samples)
    number = pl.SAMPLES * pl.FINE
    for of_bolt, curve, solid, begin in ((True, BOLT, NUT, 0), (False, NUT, BOLT, 2 * number)):
        points = threads.samples[pl.S_POINTS + begin :]
        depths = np.empty(number)
        pl.set_depths(of_bolt, number, place, points, points[number:], solid, depths)
        expected = [gk.edge_depth(of_bolt, 2.0 * math.pi * i / number, place, curve, solid) for i in range(number)]
        assert depths == pytest.approx(expected, abs=1e-14)
        assert depths.min() < 0.0 < depths.max()


@pytest.fixture(scope="module")
def path() -> AssemblyPath:
    """A path on which two maxima of the threads lie between two azimuths of the search's grid."""
    return assemble_pose(UNC, -4.0, 0.0, 130.0, strategy=Strategy.CW)


def test_what_a_search_does_not_tell_apart_is_remembered(path: AssemblyPath) -> None:
    """Contacts of the path are missed by a search that knows nothing of the one before; the path goes on to its end."""
    assert path.outcome is AssemblyOutcome.ENGAGED
    assert not any(event.kind is PathEventKind.BRIDGED for event in path.events)
    missed = 0
    for point in path.points:
        touching = [contact for contact in point.contacts if contact.features is FeaturePair.THREAD_THREAD]
        place = place_of(np.array(point.pose.rotation), np.array(point.pose.translation))
        places = found(place, 0.005 * R, pl.new_threads(BOLT))
        for contact in touching:
            apart = np.abs(places[:, gk.G_POINT : gk.G_POINT + 3] - np.array(contact.point)).max(axis=1)
            missed += bool(apart.min(initial=math.inf) > 1e-6 * R)
    assert missed > 0


def test_a_remembered_maximum_is_found_again_and_one_long_missed_is_forgotten(path: AssemblyPath) -> None:
    """What is remembered is followed to the next pose; after as many searches without it, nothing is."""
    threads = pl.new_threads(BOLT)
    for point in path.points:
        rotation, offset = np.array(point.pose.rotation), np.array(point.pose.translation)
        first = found(place_of(rotation, offset), 0.005 * R, threads)
        known = int((first[:, gk.G_PAIR] == THREAD_THREAD).sum())
        if known > 0:
            break
    assert threads.known_count[0] == known > 0
    again = found(place_of(rotation, offset), 0.005 * R, threads)
    assert sorted(again[:, gk.G_VALUE]) == pytest.approx(sorted(first[:, gk.G_VALUE]), abs=1e-12 * R)
    lifted = place_of(rotation, offset + np.array([0.0, 0.0, 0.02 * R]))
    for _ in range(pl.FORGOTTEN):
        assert (found(lifted, 1e-6 * R, threads)[:, gk.G_PAIR] != THREAD_THREAD).all()
        assert threads.known_count[0] == known
    found(lifted, 1e-6 * R, threads)
    assert threads.known_count[0] == 0


def test_two_maxima_of_an_edge_beside_each_other_are_both_found() -> None:
    """A path that ended where two maxima of the bolt's edge lie 0.02 rad apart, one of them in another's bracket."""
    turned = assemble_pose(UNC, -2.0, 0.0, 0.0, strategy=Strategy.CW)
    assert turned.outcome is AssemblyOutcome.ENGAGED
    assert not any(event.kind in (PathEventKind.BRIDGED, PathEventKind.FALL) for event in turned.events)


def test_a_contact_goes_on_from_an_edge_into_the_threads_and_back(path: AssemblyPath) -> None:
    """Between two points of the path where a contact changes its features, it is followed from either one's place."""
    changes = 0
    for before, after in zip(path.points, path.points[1:], strict=False):
        for old, new in ((before, after), (after, before)):
            pairs = {contact.features for contact in old.contacts} ^ {contact.features for contact in new.contacts}
            if FeaturePair.THREAD_THREAD not in pairs or len(old.contacts) != len(new.contacts):
                continue
            threads = pl.new_threads(BOLT)
            places = found(place_of(np.array(old.pose.rotation), np.array(old.pose.translation)), TOUCHING, threads)
            place = place_of(np.array(new.pose.rotation), np.array(new.pose.translation))
            for gap in places:
                pair, _, _ = near.place_near(gap, place, BOLT, NUT, threads, np.zeros(gk.EDGE_JET_SIZE))
                assert pair != near.NOWHERE
                changes += int(gap[gk.G_PAIR]) in (EDGE_THREAD, THREAD_EDGE) and pair == THREAD_THREAD
                changes += int(gap[gk.G_PAIR]) == THREAD_THREAD and pair != THREAD_THREAD
    assert changes > 0


def test_newton_leads_to_the_place_that_a_bracket_has(path: AssemblyPath) -> None:
    """A place along an edge, from 1e-3 rad beside it; where what it was is another of its kinds, it leads nowhere."""
    kinds = {near.ON_PHI: 0, near.ON_BOTH: 0}
    for point in path.points[::20]:
        place = place_of(np.array(point.pose.rotation), np.array(point.pose.translation))
        for gap in found(place, TOUCHING, pl.new_threads(BOLT)):
            pair, jet = int(gap[gk.G_PAIR]), np.zeros(gk.EDGE_JET_SIZE)
            if pair == THREAD_THREAD:
                continue
            of_bolt = pair != THREAD_EDGE
            curve, solid = (BOLT, NUT) if of_bolt else (NUT, BOLT)
            theta, kind = float(gap[gk.G_THETA]), near.kind_of(pair)
            bracketed, at = pl.bracketed_peak(of_bolt, theta - 2e-3, theta + 2e-3, place, curve, solid, jet)
            is_found, reached = near.newton_peak(of_bolt, theta + 1e-3, kind, place, curve, solid, jet)
            if bracketed == kind and is_found:
                assert reached == pytest.approx(at, abs=1e-9)
                kinds[kind] += 1
            other = near.ON_BOTH if kind == near.ON_PHI else near.ON_PHI
            leads, reached = near.newton_peak(of_bolt, theta, other, place, curve, solid, jet)
            assert not leads or abs(reached - theta) > 1e-9
    assert min(kinds.values()) > 0
