"""The three stages of a pose by the collision of meshes (method, section 4; the paper, section 6)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.contact import _stage_kernel as stage
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.chamfer_contact import edge_tangent, set_side
from threadstate.mesh.chamfer_deviation import chamfered_deviation
from threadstate.mesh.clusters import Cluster, Connectivity, Neighbourhood, connected
from threadstate.mesh.collision import Collider, Engine, TooManyPairsError
from threadstate.mesh.flush_patch import extreme_points
from threadstate.mesh.frames import along, fixed_from_bolt, trans, turned
from threadstate.mesh.options import Descent, MeshOptions, Tangent
from threadstate.mesh.part import pitches_long
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solid import Floats, Solid
from threadstate.mesh.steps import Reached, approach, decades, march_and_halve, regress
from threadstate.mesh.touch import NoContactPointError, Touch, closes_a_gap, touch, touches_beyond
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair, Part

FIRST_STEP = 0.2
"""First step of a descent in decades, in thread pitches: the paper's 0.01 in."""
MARCH_STEP = 2e-3
"""Step of the march of a safe turn and of a lift, in thread pitches of arc at the bolt's major radius."""
MAX_STEPS = 20_000
"""Steps after which a safe descent gives up: the bolt slides down beside the nut, nearer than the final step."""
BEFORE_FLUSH = 4.0
"""A turn that ends flush is searched up to this many final steps of arc before: there everything meets at once."""
JUMP_GROWTH = 6
"""Beyond a growth of overlaps by a tenth and so many pairs of triangles, or sides, the step is halved, too."""
APPROACH_TURN = 1e-4
"""The further turn (rad) by which it is decided whether the parts approach each other at a contact."""
NOISE = 4.0
"""An embedment counts beyond this many times the errors of meshes and steps."""

Clusters = tuple[Cluster, ...]
Touches = tuple[Touch, ...]


EDGES_OF_BOLT = (stage.EDGE_SURFACE, stage.EDGE_THREAD, stage.THREAD_SURFACE, stage.THREAD_THREAD)
"""Features of a contact in which an edge of the bolt may meet a face of the nut."""


class Undecided(Exception):  # noqa: N818 - it never leaves this class
    """Why a pose cannot be answered."""


class MeshProcedure:
    """The paper's procedure for the meshes of a pair."""

    def __init__(self, pair: Pair, options: MeshOptions, engine: Callable[[Solid, Solid], Engine] = Collider) -> None:
        self._engine = engine
        self.pair = self._pair = pair
        self._options = options
        self._bolt, self._nut = (scene_part(pair, part, options.tessellation, options.scene) for part in Part)
        self._set_up_search()
        self._final = options.final_step * pair.thread_pitch
        self._arm = pair.fit.bolt_major_diameter / 2.0
        cut = pair.chamfer is not None and pair.chamfer.end_diameter < pair.fit.bolt_major_diameter
        self._chamfer = pair.chamfer if cut else None
        self.edge_deviation = sum(
            chamfered_deviation(solid, profile, chamfer).edge
            for solid, profile, chamfer in ((self._bolt, pair.bolt, pair.chamfer), (self._nut, pair.nut, None))
        )

    @property
    def _near_edge(self) -> float:
        """How near to both thread and cone a contact is that may be on their edge."""
        return 2.0 * (self.edge_deviation + self._final)

    def _set_up_search(self) -> None:
        self._collider = self._engine(self._bolt, self._nut)
        self._connectivity = Connectivity(self._bolt, self._nut)

    def solve_options(self, options: SolveOptions) -> SolveOptions:
        """The options with an embedment tolerance that no noise of meshes and steps reaches."""
        noise = NOISE * (self.edge_deviation + self._final) / self._pair.thread_pitch
        return replace(options, embedment_tolerance=min(1e-2, max(options.embedment_tolerance, noise)))

    def solve(self, pose_deg: tuple[float, float, float], options: SolveOptions) -> Floats:
        """The record of a pose (roll, pitch, phase in degrees); see ``contact._record_kernel`` for its layout.

        Raises:
            MeshUndecidedError: the meshes cannot answer.
        """
        row = np.zeros(rk.RECORD_SIZE)
        for i in (rk.O_LAMBDA, rk.O_MU, rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT):
            row[i] = math.nan
        try:
            self._first_stage(pose_deg, options, row)
        except (Undecided, NoContactPointError, TooManyPairsError) as error:
            raise MeshUndecidedError(*pose_deg, str(error)) from None
        return row

    def first_pose(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, Clusters]:
        """The pose ``T_nut_bolt`` (4, 4) in which the descending meshes first collide, and the clusters there.

        It is the last and blocked place of the descent: lower than first contact by at most the final step.

        Raises:
            MeshUndecidedError: they never collide, or slide beside each other too long.
        """
        try:
            return self._descend(pose_deg)
        except (Undecided, TooManyPairsError) as error:
            raise MeshUndecidedError(*pose_deg, str(error)) from None

    def _descend(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, Clusters]:
        roll, pitch, phase = (math.radians(angle) for angle in pose_deg)
        level = fixed_from_bolt(roll, pitch, phase, np.zeros(3))
        p = self._pair.thread_pitch
        start = -float((self._bolt.vertices @ level[2, :3]).min()) + 2.0 * self._final

        def pose(travel: float) -> Floats:
            return trans([0.0, 0.0, start - travel]) @ level

        def meets(travel: float) -> bool | None:
            return self._collides(pose(travel)) or None

        limit = start + p * pitches_long(self._pair)
        if self._options.descent is Descent.DECADES:
            reached = regress(meets, decades(FIRST_STEP * p, self._final), limit)
        else:
            try:
                reached = approach(
                    meets, lambda travel: self._collider.distance(pose(travel)), self._final, limit, MAX_STEPS
                )
            except TimeoutError:
                raise Undecided(f"the bolt slides beside the nut for more than {MAX_STEPS} steps") from None
        if reached is None:
            raise Undecided("the meshes do not collide on the way down by a thread pitch")
        blocked = pose(reached.place)
        return blocked, self._clusters(blocked)

    def _clusters(self, T_nut_bolt: Floats) -> Clusters:
        return self._connectivity.clusters(self._collider.pairs(T_nut_bolt))

    def _touches(self, clusters: Iterable[Cluster], T_nut_bolt: Floats) -> Touches:
        """The contacts that clusters are, by azimuth on the nut, from 0 on."""
        found = (touch(cluster, self._bolt, self._nut, T_nut_bolt) for cluster in clusters)
        return tuple(sorted(found, key=lambda one: math.atan2(one.point[1], one.point[0]) % (2.0 * math.pi)))

    def _first_stage(self, pose_deg: tuple[float, float, float], options: SolveOptions, row: Floats) -> None:
        first, touches = self._first_touches(pose_deg)
        if self._is_level(first):
            self._lie_level(first, row)
            return
        self._append_pose(first, row)
        self._append_contacts(1, touches[:1], first, row)
        if len(touches) > 1:
            sk.add_flag(row, rk.FLAG_TIE)
            row[rk.O_LAMBDA] = 0.0
            self._after_second(first, touches[0], touches[1:], options, row)
            return
        self._second_stage(first, touches[0], options, row)

    def _first_touches(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, Touches]:
        """The pose at the end of the descent, and the contacts there of a bolt that is not level."""
        first, clusters = self._descend(pose_deg)
        return first, () if self._is_level(first) else self._touches(clusters, first)

    def _is_level(self, T_nut_bolt: Floats) -> bool:
        return math.hypot(T_nut_bolt[2, 0], T_nut_bolt[2, 1]) * self._arm < self._final

    def _lie_level(self, first: Floats, row: Floats) -> None:
        """A level bolt: a patch on the surface, undecided on its thread, where facets cannot show a crossing."""
        if first[2, 3] < -BEFORE_FLUSH * self._final:
            rests = "a level bolt in phase rests on a strip of its thread"
            if self._chamfer is not None:
                rests = "a level bolt with a chamfer rests on an arc of its cone, or on a strip of its thread"
            raise Undecided(f"{rests}: facets in one plane have no segment")
        self._append_flush_pose(1, first, np.array([1.0, 0.0, 0.0]), row)

    def _second_stage(self, first: Floats, cp0: Touch, options: SolveOptions, row: Floats) -> None:
        numbers = cp0.numbers(first)
        reverse = np.zeros(3)
        sk.second_axis(numbers, _flat(first), self._pair.bolt.packed, self._pair.nut.packed, reverse)
        self._set_chamfer_axis(cp0, first, reverse)
        if self._options.tangent is Tangent.AZIMUTHAL:
            x, y, _ = cp0.point
            reverse = np.array([y, -x, 0.0]) / math.hypot(x, y)
        tangent = -reverse
        frame = along(tangent, cp0.point)

        def pose(turn: float) -> Floats:
            return turned(first, frame, -turn)

        limit = math.radians(options.turn_limit_deg)
        flush = math.nan
        if cp0.features == stage.EDGE_SURFACE and self._options.tangent is Tangent.EDGE:
            flush = float(sk.turn_to_flush(_flat(first), reverse))
            if 0.0 <= flush <= limit:
                limit = max(0.0, flush - BEFORE_FLUSH * self._final / self._arm)
        reached = self._turn(pose, [cp0], limit)
        if reached is None:
            if flush >= 0.0 and self._append_flush_pose(2, pose(flush), tangent, row):
                row[rk.O_LAMBDA] = flush
            else:
                sk.add_flag(row, rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD)
            return
        row[rk.O_LAMBDA] = reached.place
        second = pose(reached.place)
        touches = reached.found
        if len(touches) > 1:
            sk.add_flag(row, rk.FLAG_TIE)
        self._after_second(second, cp0, touches, options, row)

    def _set_chamfer_axis(self, cp0: Touch, first: Floats, reverse: Floats) -> None:
        """Where the nut's surface or thread meets an edge of a chamfered bolt, the axis is that edge's tangent."""
        if self._chamfer is None or cp0.features not in EDGES_OF_BOLT:
            return
        tangent = edge_tangent(self._pair, self._chamfer, _flat(first), cp0.point, self._near_edge)
        if tangent is not None:
            if cp0.features in (stage.EDGE_SURFACE, stage.THREAD_SURFACE):
                tangent[2] = 0.0
                tangent /= np.linalg.norm(tangent)
            x, y, _ = cp0.point
            reverse[:] = tangent if x * tangent[1] - y * tangent[0] < 0.0 else -tangent

    def _after_second(self, second: Floats, cp0: Touch, touches: Touches, options: SolveOptions, row: Floats) -> None:
        """Continue after CP1, the first of the touches; further touches are the third stage."""
        cp1, more = touches[0], touches[1:]
        self._append_pose(second, row)
        self._append_contacts(2, (cp1,), second, row)
        axis = (cp1.point - cp0.point) / np.linalg.norm(cp1.point - cp0.point)
        row[rk.O_PIVOT] = float(np.linalg.norm(np.cross(axis, second[:3, 3] - cp0.point)))
        if more:
            row[rk.O_MU] = row[rk.O_DROP] = row[rk.O_EMBEDMENT] = 0.0
            self._append_pose(second, row)
            self._append_contacts(3, more, second, row)
            return
        moment = origin_moment(cp0.point, cp1.point, second[:3, 3])
        if abs(moment) > self._final:
            self._third_stage(second, cp0, cp1, -math.copysign(1.0, moment), options, row)
            return
        sk.add_flag(row, rk.FLAG_BALANCED)
        other = row.copy()
        self._third_stage(second, cp0, cp1, 1.0, options, row)
        self._third_stage(second, cp0, cp1, -1.0, options, other)
        if not math.isnan(other[rk.O_MU]) and not row[rk.O_MU] <= other[rk.O_MU]:
            row[:] = other

    def _third_stage(
        self, second: Floats, cp0: Touch, cp1: Touch, sense: float, options: SolveOptions, row: Floats
    ) -> None:
        axis = (cp1.point - cp0.point) / np.linalg.norm(cp1.point - cp0.point)
        frame = along(axis, cp0.point)

        def pose(turn: float) -> Floats:
            return turned(second, frame, sense * turn)

        limit = math.radians(options.turn_limit_deg)
        flush = math.nan
        if sk.lies_in_both_planes(cp0.features) and sk.lies_in_both_planes(cp1.features):
            flush = float(sk.turn_to_flush(_flat(second), sense * axis))
            if 0.0 < flush <= limit:
                limit = max(0.0, flush - BEFORE_FLUSH * self._final / self._arm)
        reached = self._turn(pose, [cp0, cp1], limit)
        if reached is None:
            if flush > 0.0 and self._append_flush_pose(3, pose(flush), axis, row):
                row[rk.O_MU] = flush
                row[rk.O_DROP] = second[2, 3] - row[rk.O_POSE + 35]
                row[rk.O_EMBEDMENT] = 0.0
            else:
                sk.add_flag(row, rk.FLAG_NO_THIRD)
            return
        third = pose(reached.place)
        touches = reached.found
        if len(touches) > 1:
            sk.add_flag(row, rk.FLAG_TIE)
        row[rk.O_MU] = reached.place
        self._append_pose(third, row)
        self._append_contacts(3, touches, third, row)
        row[rk.O_DROP] = second[2, 3] - third[2, 3]
        row[rk.O_EMBEDMENT] = self._least_lift(third)

    def _turn(self, pose: Callable[[float], Floats], known: list[Touch], limit: float) -> Reached[Touches] | None:
        """The smallest turn (rad) at which contacts appear that hold none of the known ones, and those contacts.

        A cluster holds a contact where it lies in the ring of triangles about it on both meshes. One that is connected
        with a cluster of the place before is not new: it may grow and roll away, and parts of it may part. A hole in
        an overlap does not count, nor does what touches a part's far end.
        """
        before: Clusters = tuple(one.cluster for one in known)
        own = [self._connectivity.neighbourhood(cluster) for cluster in before]
        about = [self._connectivity.neighbourhood(cluster, rings=1) for cluster in before]
        since = 0.0
        final = self._final / self._arm

        def found(turn: float) -> Touches | None:
            nonlocal before, since
            T_nut_bolt, later = pose(turn), pose(turn + APPROACH_TURN)
            clusters = self._clusters(T_nut_bolt)
            new = self._touches((one for one in clusters if self._is_new(one, own, before)), T_nut_bolt)
            onsets = tuple(one for one in new if closes_a_gap(one, self._bolt, self._nut, T_nut_bolt, later))
            if not onsets:
                if turn - since > final and _has_jumped(before, clusters):
                    return found(0.5 * (since + turn)) or found(turn)
                before, since = clusters, turn
                return None
            if any(self._connectivity.reaches(one.cluster, place) for one in onsets for place in about):
                raise Undecided(
                    "a contact appears within a ring of triangles about an earlier one: too near for these meshes"
                )
            return onsets

        p = self._pair.thread_pitch
        if self._options.descent is Descent.DECADES:
            return regress(found, decades(FIRST_STEP * p / self._arm, final), limit)
        return march_and_halve(found, MARCH_STEP * p / self._arm, final, limit)

    def _is_new(self, cluster: Cluster, places: list[Neighbourhood], before: Clusters) -> bool:
        return (
            not any(self._connectivity.reaches(cluster, place) for place in places)
            and not any(connected(cluster, one) for one in before)
            and not touches_beyond(cluster, self._bolt, self._nut)
        )

    def _least_lift(self, T_nut_bolt: Floats) -> float:
        """The least lift after which the meshes do not collide."""

        def free(lift: float) -> bool | None:
            return None if self._collides(trans([0.0, 0.0, lift]) @ T_nut_bolt) else True

        p = self._pair.thread_pitch
        reached = march_and_halve(free, MARCH_STEP * p, self._final, 2.0 * (p + self._arm))
        if reached is None:
            raise Undecided("no lift frees the third pose")
        return reached.place

    def _collides(self, T_nut_bolt: Floats) -> bool:
        return self._collider.collides(T_nut_bolt)

    def _append_flush_pose(self, number: int, T_nut_bolt: Floats, axis: Floats, row: Floats) -> bool:
        """Append the flush pose and the extreme points of its patch that are no contacts yet; False without a patch."""
        level = T_nut_bolt.copy()
        level[2, :3] = level[:3, 2] = (0.0, 0.0, 1.0)
        level[2, 3] = 0.0
        extremes = extreme_points(self._bolt, self._nut, level, axis)
        if not extremes:
            return False
        self._append_pose(level, row)
        known = int(row[rk.O_CONTACTS])
        used = row[rk.O_CONTACT : rk.O_CONTACT + rk.POINT_SIZE * known].reshape(known, rk.POINT_SIZE)
        places = used[:, rk.P_POINT : rk.P_POINT + 2].copy()
        for one in extremes:
            x, y = one.point.tolist()
            # A contact's place is known to a segment of the mesh: an extreme point that near is the contact.
            if len(places) and np.hypot(places[:, 0] - x, places[:, 1] - y).min() < self.segment:
                continue
            rk.append_flush_point(
                number, one.bolt_azimuth, one.corner, x, y, self._pair.bolt.packed, self._pair.nut.packed, row
            )
            self._set_side(_flat(level), row)
        sk.add_flag(row, rk.FLAG_FLUSH)
        return True

    @cached_property
    def segment(self) -> float:
        """The longest segment of the bolt's outline, in the pair's unit."""
        edge = self._bolt.vertices[self._bolt.edge]
        return float(np.linalg.norm(edge - np.roll(edge, 1, axis=0), axis=1).max())

    def _append_pose(self, T_nut_bolt: Floats, row: Floats) -> None:
        rk.append_pose(_flat(T_nut_bolt), row)

    def _append_contacts(self, number: int, touches: Touches, T_nut_bolt: Floats, row: Floats) -> None:
        bolt, nut = self._pair.bolt.packed, self._pair.nut.packed
        flat = _flat(T_nut_bolt)
        for one in touches:
            numbers = one.numbers(T_nut_bolt)
            rk.append_contact(number, numbers, flat, bolt, nut, row)
            self._set_side(flat, row)
            if rk.grazes(numbers, flat, bolt, nut):
                sk.add_flag(row, rk.FLAG_GRAZING)

    def _set_side(self, pose: Floats, row: Floats) -> None:
        """Of a chamfered bolt, set what the last contact of a record has of its side."""
        if self._chamfer is not None:
            at = rk.O_CONTACT + rk.POINT_SIZE * (int(row[rk.O_CONTACTS]) - 1)
            set_side(self._pair, self._chamfer, pose, row[at : at + rk.POINT_SIZE], self._near_edge)


def _has_jumped(before: Clusters, after: Clusters) -> bool:
    """Whether the overlaps have grown so much between two places that a new one may have joined them already."""
    return _pair_count(after) > 1.1 * _pair_count(before) + JUMP_GROWTH


def _pair_count(clusters: Clusters) -> int:
    return sum(len(cluster.pairs) for cluster in clusters)


def _flat(T_nut_bolt: Floats) -> Floats:
    """A pose as the kernels' twelve numbers: rotation by rows, translation."""
    return np.concatenate([T_nut_bolt[:3, :3].ravel(), T_nut_bolt[:3, 3]])


def origin_moment(cp0: ArrayLike, cp1: ArrayLike, origin: ArrayLike) -> float:
    """How fast the bolt's origin rises as the bolt turns about the unit axis from ``cp0`` to ``cp1``; a length.

    All three are points of the nut's frame. Its reverse is the moment of a unit force along -z through the origin.
    """
    a, b, o = (np.asarray(point, dtype=np.float64) for point in (cp0, cp1, origin))
    axis = (b - a) / np.linalg.norm(b - a)
    return float(np.cross(axis, o - a)[2])
