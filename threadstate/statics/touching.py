"""Where a state's solids touch in its last pose, and the normals there (forces, section 2).

A state stores each contact in the pose of its stage. In the last pose an earlier contact is at the same point, which
lies on the axes of the later turns, but the features have turned against each other and the normal with them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.errors import UnresolvedPoseError
from threadstate.state.encode import geometry_records
from threadstate.state.flat_base import require_flat_base
from threadstate.state.model import Contact, ContactState, Flag, StagePose, Vector
from threadstate.statics import _patch_kernel as hk
from threadstate.statics._last_pose_kernel import set_contacts
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Touching:
    """Contacts of a state's last pose, in the nut's frame, lengths in the pair's unit.

    Attributes:
        points: shape (k, 3), read-only; the state's own contacts first, then the hull of its patch, or the outline of
            its strip of flank.
        normals: shape (k, 3), read-only; unit vectors from the nut into the bolt.
        own: how many are the state's own contacts.
        origin: the bolt's origin.
        patch: whether they are a level patch, all normals up.
        strip: whether they are a strip of flank on flank along a helix.
        gap: how far the hull of the true patch or strip may lie outside of the one of these points; else 0.
        penetrating: whether the solids overlap in the last pose by more than the tolerance: no forces are real there.
    """

    points: Floats
    normals: Floats
    own: int
    origin: tuple[float, float, float]
    patch: bool
    strip: bool
    gap: float
    penetrating: bool

    @property
    def carriers(self) -> slice:
        """Which of the contacts carry forces: all of them, or the hull of a patch, the outline of a strip."""
        return slice(self.own, None) if self.patch or self.strip else slice(None)


def touching(pair: Pair, state: ContactState) -> Touching:
    """Where the solids touch in the last pose of a state.

    Raises:
        InvalidValueError: the pair's bolt has a chamfer.
        UnresolvedPoseError: two edges are parallel where they touch, or a patch is too narrow for its hull.
    """
    require_flat_base(pair, "statics")
    last = state.poses[-1]
    points = [contact.point for contact in state.contacts]
    normals = [contact.normal for contact in state.contacts]
    gap, patch, strip = 0.0, False, False
    if Flag.FLUSH not in state.flags:
        normals = _last_normals(pair, state)
    elif last.translation[2] < 0.0:
        strip = True
        outline, gap = strip_outline(state.contacts)
        points += [point for point, _ in outline]
        normals += [normal for _, normal in outline]
    else:
        patch = True
        hull, gap = patch_hull(pair, last)
        if len(hull) < 3:
            pose = state.roll_deg, state.pitch_deg, state.phase_deg
            raise UnresolvedPoseError(*pose, "the patch on which the bolt lies is too narrow for its hull")
        points += hull
        normals = [(0.0, 0.0, 1.0)] * len(points)
    return Touching(
        points=_read_only(points),
        normals=_read_only(normals),
        own=len(state.contacts),
        origin=last.translation,
        patch=patch,
        strip=strip,
        gap=gap,
        penetrating=state.embedment_margin is not None and state.embedment_margin < 0.0,
    )


STRIP_SAMPLES = 33
"""Points of each of the two curves of a strip's outline."""


STRIP_CORNERS = 4


def strip_outline(corners: Sequence[Contact]) -> tuple[list[tuple[Vector, Vector]], float]:
    """Points and normals on the upper and the lower curve of strips of flank, and how far a strip lies outside.

    On a flank the height grows linearly with radius and azimuth: a curve of one height is a spiral of Archimedes, and
    the normal's slopes along the radius and, times the radius, across it are those of its corners. Between two samples
    points and normals leave their chords by at most an eighth of the step of azimuth squared.
    """
    found, gap = [], 0.0
    for number in range(0, len(corners), STRIP_CORNERS):
        strip = corners[number : number + STRIP_CORNERS]
        for height in sorted({contact.point[2] for contact in strip}):
            first, last = (contact for contact in strip if contact.point[2] == height)
            (azimuth, start), end = _polar(first), _polar(last)[1]
            ex, ey, ez = first.normal
            along = (ex * math.cos(azimuth) + ey * math.sin(azimuth)) / ez
            across = (ey * math.cos(azimuth) - ex * math.sin(azimuth)) / ez * start
            turn = -along / across * (end - start)
            for share in np.linspace(0.0, 1.0, STRIP_SAMPLES).tolist():
                angle, radius = azimuth + share * turn, start + share * (end - start)
                cosine, sine, side = math.cos(angle), math.sin(angle), across / radius
                size = math.sqrt(1.0 + along * along + side * side)
                normal = (along * cosine - side * sine) / size, (along * sine + side * cosine) / size, 1.0 / size
                found.append(((radius * cosine, radius * sine, height), normal))
            gap = max(gap, max(start, end) * (turn / (STRIP_SAMPLES - 1)) ** 2 / 8.0)
    return found, gap


def _polar(contact: Contact) -> tuple[float, float]:
    x, y, _ = contact.point
    return math.atan2(y, x), math.hypot(x, y)


def _last_normals(pair: Pair, state: ContactState) -> list[Vector]:
    (record,) = geometry_records([state])
    count = len(state.contacts)
    points, normals = np.empty((count, 3)), np.empty((count, 3))
    certain = set_contacts(record, pair.bolt.packed, pair.nut.packed, points, normals)
    if certain < count:
        raise UnresolvedPoseError(
            state.roll_deg,
            state.pitch_deg,
            state.phase_deg,
            f"the edges of contact {certain + 1} are parallel in the last pose, which leaves its normal open",
        )
    return [(x, y, z) for x, y, z in normals.tolist()]


def patch_hull(pair: Pair, pose: StagePose) -> tuple[list[tuple[float, float, float]], float]:
    """The hull, counter-clockwise, of the patch on which a flush bolt lies, and how far outside it the patch may reach.

    Between two samples an arc of the bolt's outline leaves its chord by at most an eighth of the chord's length squared
    times the outline's largest curvature.
    """
    placed = np.array([*np.ravel(pose.rotation), *pose.translation])
    hull = np.empty((2 * hk.OUTLINE_SAMPLES + 1, 2))
    count = hk.patch_hull(placed, pair.bolt.packed, pair.nut.packed, hull)
    chord = TWO_PI / hk.OUTLINE_SAMPLES * pair.bolt.major_diameter / 2.0
    return [(x, y, 0.0) for x, y in hull[:count].tolist()], _largest_curvature(pair) * chord * chord / 8.0


def _largest_curvature(pair: Pair) -> float:
    """A bound of the curvature of the bolt's outline ``r = f(-k theta)``, over the pair's length unit."""
    k = pair.bolt.advance
    half_angle = min(pair.bolt.half_angles)
    slope = k / math.tan(half_angle)
    low = pair.bolt.minor_diameter / 2.0
    high = pair.bolt.major_diameter / 2.0
    secant = 1.0 / math.sin(half_angle)
    radii = [radius for radius in (pair.bolt.minor_fillet_radius, pair.bolt.major_fillet_radius) if radius > 0.0]
    second = max((k * k * secant**3 / radius for radius in radii), default=0.0)
    return (high * high + 2.0 * slope * slope + high * second) / low**3


def _read_only(rows: list[tuple[float, float, float]]) -> Floats:
    array = np.array(rows, dtype=np.float64).reshape(-1, 3)
    array.setflags(write=False)
    return array
