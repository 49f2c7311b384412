"""States to fifty digits: the equations of their contacts solved in balls, stage upon stage.

A solver's state says which features touch and about where. From there Newton's method solves the equations of the
method's sections 1 and 4, with profiles from the threads' dimensions; the last step, taken over a ball about the
solution, proves that the ball holds one and only one. What is uncertain of a stage is in the balls that the next
stage starts from. Whether another contact comes earlier is not looked at.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from flint import arb, arb_mat, ctx
from numpy.typing import NDArray

from studies.certificate.balls import ZERO
from studies.certificate.functions import Function, FunctionVector, variables
from studies.certificate.placements import (
    NOWHERE,
    Motion,
    Pose,
    Vector,
    added,
    azimuth,
    columns,
    cross,
    rotated,
    scaled,
    unit,
    values,
)
from studies.certificate.profiles import BallProfile, ball_profile
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _stage_kernel as sk
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Equations = Callable[[tuple[arb, ...]], tuple[list[arb], list[tuple[arb, ...]]]]

PRECISION = 300
"""Bits of all balls: what Newton's method and three stages lose leaves more than fifty digits."""

MOST_STEPS = 60
NEAR = arb(1) / 50
"""How far (rad, and thread pitches) a solution may be from the record: beyond, another contact is meant."""
SETTLED = arb(2) ** -180
"""A step of Newton's method, in radians or thread pitches, after which the solution is enclosed."""

EDGES_OF_BOLT = (sk.EDGE_EDGE, sk.EDGE_SURFACE, sk.EDGE_THREAD)
EDGES_OF_NUT = (sk.BASE_EDGE, sk.THREAD_EDGE)
IN_SURFACE = (sk.EDGE_SURFACE, sk.BASE_EDGE, sk.THREAD_SURFACE)


class UncoveredError(Exception):
    """A state whose equations are not solved here; the message says why."""


@dataclass(frozen=True)
class Contact:
    """A contact: its features as in a record, its point in the nut's frame, its azimuth on bolt and nut (rad)."""

    features: int
    point: Vector
    bolt_azimuth: arb
    nut_azimuth: arb


@dataclass(frozen=True)
class ExactState:
    """The height of first contact and the turns (rad, None where a stage is absent), the contacts, the poses."""

    height: arb
    turns: tuple[arb | None, arb | None]
    contacts: tuple[Contact, ...]
    poses: tuple[Pose, ...]


@dataclass(frozen=True)
class Parts:
    """Both profiles, the thread pitch, and the lead per radian."""

    bolt: BallProfile
    nut: BallProfile
    pitch: arb
    advance: arb


def profiled(s: Function, profile: BallProfile) -> Function:
    """The radius of a profile at an axial coordinate."""
    jet = profile.exactly(s.value)
    return s.composed((jet.radius, jet.slope, jet.low.union(jet.high)))


def surface(theta: Function, z: Function, profile: BallProfile, advance: arb) -> FunctionVector:
    """The point of a thread at an azimuth and an axial position, in its own frame."""
    r = profiled(z - theta.scaled(advance), profile)
    sine, cosine = theta.sine_and_cosine()
    return r * cosine, r * sine, z


def clearance(point: FunctionVector, profile: BallProfile, advance: arb) -> Function:
    """``r - f(s)`` at a point of the profile's own frame."""
    x, y, z = point
    around = arb(math.atan2(float(y.value.mid()), float(x.value.mid())))
    sine, cosine = around.sin_cos()
    forward, sideways = x.scaled(cosine) + y.scaled(sine), y.scaled(cosine) - x.scaled(sine)
    theta = (sideways * forward.reciprocal()).arc_tangent().shifted(around)
    return (x * x + y * y).root() - profiled(z - theta.scaled(advance), profile)


def edge(theta: arb, profile: BallProfile, advance: arb) -> FunctionVector:
    """The point of an edge at an azimuth, in its own frame, with derivatives by the azimuth alone."""
    (at,) = variables((theta,))
    return surface(at, at.scaled(ZERO), profile, advance)


def place(features: int, unknowns: tuple[Function, ...], parts: Parts, motion: Motion) -> FunctionVector:
    """The contact's point on the part that the unknowns are azimuths of, in the other part's frame.

    The unknowns are the azimuth on an edge and the time; where a thread touches with its side, azimuth and axial
    position on the bolt's thread and the time.
    """
    theta, time = unknowns[0], unknowns[-1]
    z = unknowns[1] if len(unknowns) == 3 else theta.scaled(ZERO)
    if features in EDGES_OF_NUT:
        return motion.to_bolt(surface(theta, z, parts.nut, parts.advance), time)
    return motion.to_nut(surface(theta, z, parts.bolt, parts.advance), time)


def equations(features: int, parts: Parts, motion: Motion) -> Equations:
    """What vanishes at a contact of these features, with its derivatives by the unknowns.

    Edge on edge: the height over the nut's surface and the clearance of the threads; else the one of them that the
    other part has there, and its derivatives along the touching part.
    """

    def evaluated(unknowns: tuple[arb, ...]) -> tuple[list[arb], list[tuple[arb, ...]]]:
        point = place(features, variables(unknowns), parts, motion)
        profile = parts.bolt if features in EDGES_OF_NUT else parts.nut
        if features == sk.EDGE_EDGE:
            both = point[2], clearance(point, profile, parts.advance)
            return [one.value for one in both], [one.first for one in both]
        one = point[2] if features in IN_SURFACE else clearance(point, profile, parts.advance)
        along = range(len(unknowns) - 1)
        return [one.value, *(one.first[i] for i in along)], [one.first, *(one.second[i] for i in along)]

    return evaluated


def newton_step(system: Equations, at: tuple[arb, ...], over: tuple[arb, ...]) -> list[arb]:
    """Newton's step from a point, with the derivatives over a ball.

    Raises:
        UncoveredError: the derivatives may be singular.
    """
    residual, _ = system(at)
    _, slopes = system(over)
    try:
        step = arb_mat([list(row) for row in slopes]).solve(arb_mat([[one] for one in residual]))
    except ZeroDivisionError:
        raise UncoveredError("the equations may be singular") from None
    return [-step[i, 0] for i in range(len(at))]


def solved(system: Equations, start: tuple[arb, ...], scale: arb) -> tuple[arb, ...]:
    """Balls that hold the one solution near a start, proved by a step of Newton's method over them.

    ``scale`` is the size of the unknowns.

    Raises:
        UncoveredError: Newton's method does not settle, or nothing is proved.
    """
    at = start
    for _ in range(MOST_STEPS):
        step = newton_step(system, at, at)
        at = tuple((x + d).mid() for x, d in zip(at, step, strict=True))
        if not all(abs(x - x0) < NEAR for x, x0 in zip(at, start, strict=True)):
            raise UncoveredError("no solution is near the record")
        if all(abs(d.mid()) < SETTLED * scale for d in step):
            break
    else:
        raise UncoveredError("Newton's method does not settle")
    reach = [SETTLED * scale] * len(at)
    for _ in range(8):
        step = newton_step(system, at, tuple(x + arb(0, r) for x, r in zip(at, reach, strict=True)))
        if all(d.abs_upper() < r for d, r in zip(step, reach, strict=True)):
            return tuple(x + d for x, d in zip(at, step, strict=True))
        reach = [(2 * d.abs_upper()).max(r) for d, r in zip(step, reach, strict=True)]
    raise UncoveredError("no ball is proved to hold one solution")


def solved_contact(contact: Floats, time: float, parts: Parts, motion: Motion) -> tuple[Contact, arb]:
    """The contact that a record's one stands for, and its time."""
    features = int(contact[rk.P_PAIR])
    nut_point, bolt_point = contact[rk.P_POINT : rk.P_POINT + 3], contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 3]
    x, y, _ = nut_point if features in EDGES_OF_NUT else bolt_point
    start = [arb(math.atan2(y, x)), arb(time)]
    if features in (sk.THREAD_THREAD, sk.THREAD_SURFACE):
        start.insert(1, arb(bolt_point[2]))
    found = solved(equations(features, parts, motion), tuple(start), parts.pitch)
    there = values(place(features, variables(found), parts, motion))
    time_found = found[-1]
    if features in EDGES_OF_NUT:
        point = values(edge(found[0], parts.nut, parts.advance))
        return Contact(features, point, azimuth(there[0], there[1]), found[0]), time_found
    return Contact(features, there, found[0], azimuth(there[0], there[1])), time_found


def tangent(contact: Contact, pose: Pose, parts: Parts) -> Vector:
    """The unit tangent t0 at a first contact, counter-clockwise (method, section 4)."""
    x, y, _ = contact.point
    on_bolt = contact.features in EDGES_OF_BOLT and contact.features != sk.EDGE_EDGE
    if contact.features == sk.THREAD_THREAD:
        along: Vector = (-y, x, parts.advance)
    else:
        profile, at = (parts.bolt, contact.bolt_azimuth) if on_bolt else (parts.nut, contact.nut_azimuth)
        if contact.features == sk.THREAD_SURFACE:
            arm = rotated(columns(pose.rotation), added(contact.point, scaled(pose.origin, arb(-1))))
            along = rotated(pose.rotation, (-arm[1], arm[0], parts.advance))
        else:
            curve = edge(at, profile, parts.advance)
            along = (curve[0].first[0], curve[1].first[0], curve[2].first[0])
            along = rotated(pose.rotation, along) if on_bolt else along
    along = unit(along)
    return along if x * along[1] - y * along[0] > 0 else scaled(along, arb(-1))


def first_pose(angles: Vector) -> Pose:
    """The orientation of a pose, angles in rad, with the bolt's origin at the nut's (method, section 2)."""
    (sa, ca), (sb, cb), (sc, cc) = (one.sin_cos() for one in angles)
    return Pose(
        (
            (cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa),
            (sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa),
            (-sb, cb * sa, cb * ca),
        ),
        NOWHERE,
    )


def pivot_axis(contacts: list[Contact], pose: Pose) -> Vector:
    """The unit axis from one contact to the other, in the sense that lowers the bolt's origin (method, section 4).

    Raises:
        UncoveredError: the origin may lie over the axis.
    """
    first, second = (one.point for one in contacts)
    axis = unit(added(second, scaled(first, arb(-1))))
    sinks = cross(axis, added(pose.origin, scaled(first, arb(-1))))[2]
    if sinks.contains(ZERO):
        raise UncoveredError("the bolt's origin may lie over the pivot axis")
    return axis if sinks < 0 else scaled(axis, arb(-1))


def flush_turn(pose: Pose, axis: Vector) -> arb:
    """The turn about a horizontal axis in the bolt's base plane after which the base is level."""
    normal = (pose.rotation[0][2], pose.rotation[1][2], pose.rotation[2][2])
    return ((axis[0] * normal[1] - axis[1] * normal[0]) / normal[2]).atan()


def exact_state(pair: Pair, pose_deg: Floats, record: Floats) -> ExactState:
    """The state of a pose (roll, pitch, phase, shape (3,), degrees) that a solver's record is near to.

    Lengths are in the pair's unit. The points of a patch are not solved.

    Raises:
        UncoveredError: the record is unresolved, level or a tie, or the solution is not proved.
    """
    with ctx.workprec(PRECISION):
        roll, pitch, phase = (arb(float(one)) * arb.pi() / 180 for one in pose_deg)
        return _state(parts_of(pair), first_pose((roll, pitch, phase)), record)


def stage_from_record(pair: Pair, record: Floats, stage: int) -> tuple[Contact, arb]:
    """The contact of stage 2 or 3 and its turn (rad), as they follow from what the record says of earlier stages.

    Raises:
        UncoveredError: the solution is not proved.
    """
    with ctx.workprec(PRECISION):
        parts = parts_of(pair)
        first, second = (recorded_contact(one) for one in listed_contacts(record)[:2])
        pose = recorded_pose(record, stage - 1)
        if stage == 2:
            axis, turn = scaled(tangent(first, pose, parts), arb(-1)), record[rk.O_LAMBDA]
        else:
            axis, turn = pivot_axis([first, second], pose), record[rk.O_MU]
        return solved_contact(listed_contacts(record)[stage - 1], float(turn), parts, Motion(pose, first.point, axis))


def parts_of(pair: Pair) -> Parts:
    """The parts of a pair."""
    bolt, nut = ball_profile(pair.bolt), ball_profile(pair.nut)
    return Parts(bolt, nut, arb(pair.thread_pitch), arb(pair.lead) / (2 * arb.pi()))


def listed_contacts(record: Floats) -> Floats:
    """The contacts of a record, by rows."""
    return record[rk.O_CONTACT :].reshape(-1, rk.POINT_SIZE)[: int(record[rk.O_CONTACTS])]


def recorded_pose(record: Floats, stage: int) -> Pose:
    """The pose of a stage as a record has it."""
    at = rk.O_POSE + 12 * (stage - 1)
    numbers = [arb(float(one)) for one in record[at : at + 12]]
    x, y, z, origin = ((numbers[i], numbers[i + 1], numbers[i + 2]) for i in (0, 3, 6, 9))
    return Pose((x, y, z), origin)


def recorded_contact(contact: Floats) -> Contact:
    """A contact as a record has it."""
    x, y, z = (arb(float(one)) for one in contact[rk.P_POINT : rk.P_POINT + 3])
    bolt_x, bolt_y = (arb(float(one)) for one in contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 2])
    return Contact(int(contact[rk.P_PAIR]), (x, y, z), azimuth(bolt_x, bolt_y), azimuth(x, y))


def _state(parts: Parts, start: Pose, record: Floats) -> ExactState:
    if record[rk.O_STATUS] != sk.RESOLVED:
        raise UncoveredError("the record is unresolved")
    if int(record[rk.O_FLAGS]) & (rk.FLAG_TIE | rk.FLAG_BALANCED):
        raise UncoveredError("contacts are simultaneous, or both senses of the third turn are followed")
    listed = listed_contacts(record)
    if listed[0, rk.P_PAIR] == sk.FLUSH:
        raise UncoveredError("the bolt is level")
    contact, height = solved_contact(listed[0], float(record[rk.O_POSE + 11]), parts, Motion(start))
    contacts, poses = [contact], [Motion(start).pose(height)]
    turns: list[arb | None] = [None, None]
    for stage, column in ((2, rk.O_LAMBDA), (3, rk.O_MU)):
        if np.isnan(record[column]):
            break
        axis = scaled(tangent(contact, poses[0], parts), arb(-1)) if stage == 2 else pivot_axis(contacts, poses[1])
        motion = Motion(poses[-1], contacts[0].point, axis)
        if listed[-1, rk.P_PAIR] == sk.FLUSH and int(record[rk.O_POSES]) == stage:
            turn = flush_turn(poses[-1], axis)
        else:
            contact, turn = solved_contact(listed[stage - 1], float(record[column]), parts, motion)
            contacts.append(contact)
        turns[stage - 2] = turn
        poses.append(motion.pose(turn))
    return ExactState(height, (turns[0], turns[1]), tuple(contacts), tuple(poses))
