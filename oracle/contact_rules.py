"""What must hold of one contact in the pose of its stage, independent of the solver."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from oracle.profile import bolt_profile, nut_profile
from oracle.region_rule import region_at
from oracle.solids import (
    Floats,
    axial_position,
    edge_tangent,
    outside_bolt,
    outside_nut,
    outside_thread,
    outward_of_faces,
)
from threadstate.state.model import Contact, FeaturePair, StagePose
from threadstate.thread.pair import Pair
from threadstate.thread.regions import Region

ABOVE = np.array([0.0, 0.0, 1.0])
NORMAL_TOLERANCE = 3e-6
"""Of a unit normal: slopes here are differences, which are off by this much beside a boundary of regions."""


@dataclass(frozen=True)
class Touch:
    """A contact with its pose as arrays; ``bolt`` and ``nut`` are the oracle's profiles."""

    pair: Pair
    contact: Contact
    rotation: Floats
    translation: Floats
    bolt: Floats
    nut: Floats

    @classmethod
    def of(cls, pair: Pair, contact: Contact, pose: StagePose) -> Touch:
        """The contact in its stage's pose."""
        rotation, translation = np.array(pose.rotation), np.array(pose.translation)
        return cls(pair, contact, rotation, translation, bolt_profile(pair), nut_profile(pair))

    @property
    def point(self) -> Floats:
        """In the nut's frame."""
        return np.array(self.contact.point)

    @property
    def point_bolt(self) -> Floats:
        """In the bolt's frame."""
        return np.array(self.contact.point_bolt)

    @property
    def features(self) -> tuple[str, str]:
        """The bolt's and the nut's feature; those of a point of a flush patch by where it lies."""
        if self.contact.features is not FeaturePair.FLUSH:
            bolt, nut = self.contact.features.value.split("-")
            return bolt, nut
        if self.translation[2] < 0.0:
            return "thread", "thread"
        return "edge", "surface" if self.contact.nut_region is Region.SURFACE else "edge"


def frame_gap(touch: Touch) -> float:
    """How far the two points of a contact are apart in its pose."""
    return float(np.linalg.norm(touch.rotation @ touch.point_bolt + touch.translation - touch.point))


def surface_gaps(touch: Touch) -> dict[str, float]:
    """How far the contact's points are off each surface that its features name, and off the closed solids."""
    bolt_feature, nut_feature = touch.features
    gaps = {
        "bolt": max(0.0, outside_bolt(touch.point_bolt, touch.bolt)),
        "nut": max(0.0, outside_nut(touch.point, touch.nut)),
    }
    if bolt_feature in ("edge", "base"):
        gaps["base"] = abs(float(touch.point_bolt[2]))
    if bolt_feature in ("edge", "thread"):
        gaps["bolt thread"] = abs(outside_thread(touch.point_bolt, touch.bolt))
    if nut_feature in ("edge", "surface"):
        gaps["surface"] = abs(float(touch.point[2]))
    if nut_feature in ("edge", "thread"):
        gaps["nut thread"] = abs(outside_thread(touch.point, touch.nut))
    return gaps


def normal_faults(touch: Touch) -> list[str]:
    """What is wrong with the normal: unit, from the nut into the bolt, right for the features."""
    normal = np.array(touch.contact.normal)
    faults = []
    if abs(np.linalg.norm(normal) - 1.0) > 1e-12:
        faults.append("not of unit length")
    base_inward = touch.rotation @ ABOVE
    thread_inward = [-(touch.rotation @ face) for face in outward_of_faces(touch.point_bolt, touch.bolt)]
    nut_outward = [-face for face in outward_of_faces(touch.point, touch.nut)]
    bolt_feature, nut_feature = touch.features
    if (bolt_feature, nut_feature) == ("edge", "edge") and touch.contact.features is not FeaturePair.FLUSH:
        bolt_edge = touch.rotation @ edge_tangent(touch.point_bolt, touch.bolt)
        nut_edge = edge_tangent(touch.point, touch.nut)
        if max(abs(normal @ bolt_edge), abs(normal @ nut_edge)) > NORMAL_TOLERANCE:
            faults.append("not across both edges")
        # It separates the solids where it lies between the two faces that meet at each edge.
        faults += [
            f"not between the faces at the {name}'s edge"
            for name, faces in (("bolt", (base_inward, *thread_inward)), ("nut", (ABOVE, *nut_outward)))
            if not _between(normal, *faces)
        ]
        return faults
    expected: list[list[Floats]] = []
    if nut_feature == "surface" or (touch.contact.features is FeaturePair.FLUSH and nut_feature == "edge"):
        expected.append([ABOVE])
    if bolt_feature == "base":
        expected.append([base_inward])
    if bolt_feature == "thread":
        expected.append(thread_inward)
    if nut_feature == "thread":
        expected.append(nut_outward)
    faults += ["not across the face" for faces in expected if not _across(normal, faces)]
    return faults


def _across(normal: Floats, faces: Sequence[Floats]) -> bool:
    """Whether a normal is that of a face, or lies between those of the two faces of a sharp corner."""
    if len(faces) == 1:
        return bool(np.abs(faces[0] - normal).max() <= NORMAL_TOLERANCE)
    return _between(normal, *faces)


def _between(normal: Floats, *normals: Floats) -> bool:
    faces = np.column_stack(normals)
    shares = np.linalg.lstsq(faces, normal, rcond=None)[0]
    return bool(shares.min() > -NORMAL_TOLERANCE and np.abs(faces @ shares - normal).max() < 10 * NORMAL_TOLERANCE)


def region_faults(touch: Touch, tolerance: float) -> list[str]:
    """What is wrong with the regions and their margins; ``tolerance`` is a length."""
    contact, (bolt_feature, nut_feature) = touch.contact, touch.features
    faults = []
    for side, of_nut, point, profile, feature, region, margin in (
        ("bolt", False, touch.point_bolt, touch.bolt, bolt_feature, contact.bolt_region, contact.bolt_margin),
        ("nut", True, touch.point, touch.nut, nut_feature, contact.nut_region, contact.nut_margin),
    ):
        if feature in ("base", "surface"):
            # The nearest boundary of a flat face is the edge curve: no farther than along the radius.
            if region.value != feature or not -tolerance <= margin <= abs(outside_thread(point, profile)) + tolerance:
                faults.append(f"{side}: {region}, {margin}")
            continue
        rule = region_at(touch.pair, axial_position(point, profile), of_nut=of_nut)
        if region is not rule.region and rule.axial_distance > tolerance:
            faults.append(f"{side}: {region}, should be {rule.region}")
        # Arc length beside the end of a fillet is known only to the root of round-off.
        if abs(margin - rule.margin) > 10 * tolerance:
            faults.append(f"{side} margin: {margin}, should be {rule.margin}")
    return faults
