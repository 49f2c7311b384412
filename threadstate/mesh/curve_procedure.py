"""The three stages without triangles: the two edge curves as polygons, the rest in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from threadstate.contact import _stage_kernel as stage
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.clusters import Cluster
from threadstate.mesh.edge_curve import EdgeCurve, distance
from threadstate.mesh.frames import apply, fixed_from_bolt, inverse, trans
from threadstate.mesh.options import Descent, MeshOptions
from threadstate.mesh.procedure import (
    APPROACH_TURN,
    FIRST_STEP,
    JUMP_GROWTH,
    MARCH_STEP,
    MeshProcedure,
    Touches,
    Undecided,
)
from threadstate.mesh.solid import Floats
from threadstate.mesh.steps import Reached, decades, march_and_halve, regress
from threadstate.mesh.touch import Touch
from threadstate.thread.pair import Pair

NO_PAIRS = Cluster(np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int64))
AT_THE_EDGE = 4.0
"""An edge that enters within this many chord deviations of the other part's edge enters at that edge."""
NEAR = 1.0
"""Runs that are at most this many sides apart are one run."""
TOO_NEAR = 2.0
"""A contact that appears within this many sides of an earlier one is part of its growth."""


@dataclass(frozen=True, eq=False)
class Runs:
    """The runs of the bolt's edge inside the nut and of the nut's inside the bolt: (k, 2) each."""

    bolt: Floats
    nut: Floats

    @property
    def sides(self) -> float:
        """How many sides they cover together."""
        return float(sum((runs[:, 1] - runs[:, 0]).sum() for runs in (self.bolt, self.nut)))


class CurveProcedure(MeshProcedure):
    """The paper's procedure for the scene without meshes, edge curves.

    Overlaps are known by the runs of the two edge curves inside the other part. Where thread meets thread no edge is
    inside: such contacts are not seen.
    """

    def __init__(self, pair: Pair, options: MeshOptions) -> None:
        super().__init__(pair, options)
        self._bolt_edge, self._nut_edge = EdgeCurve(self._bolt, pair.bolt, -1.0), EdgeCurve(self._nut, pair.nut, 1.0)
        self._side = max(self._bolt_edge.longest_side, self._nut_edge.longest_side)

    def _set_up_search(self) -> None:
        """Nothing: there are no triangles."""

    def _overlaps(self, T_nut_bolt: Floats) -> Runs:
        return Runs(
            self._bolt_edge.runs_inside(self._nut_edge, T_nut_bolt),
            self._nut_edge.runs_inside(self._bolt_edge, inverse(T_nut_bolt)),
        )

    def first_pose(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, tuple[Cluster, ...]]:
        """As by meshes, without clusters: there are none."""
        try:
            return self._lowered(pose_deg)[0], ()
        except Undecided as error:
            raise MeshUndecidedError(*pose_deg, str(error)) from None

    def _first_touches(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, Touches]:
        first, overlaps = self._lowered(pose_deg)
        return first, _by_azimuth(self._touches_of(overlaps, first))

    def _lowered(self, pose_deg: tuple[float, float, float]) -> tuple[Floats, Runs]:
        """The pose in which edges first enter, and where."""
        roll, pitch, phase = (math.radians(angle) for angle in pose_deg)
        level = fixed_from_bolt(roll, pitch, phase, np.zeros(3))
        p = self._pair.thread_pitch
        start = -float((self._bolt.vertices @ level[2, :3]).min()) + 2.0 * self._final

        def pose(travel: float) -> Floats:
            return trans([0.0, 0.0, start - travel]) @ level

        def found(travel: float) -> Runs | None:
            overlaps = self._overlaps(pose(travel))
            return overlaps if overlaps.sides else None

        limit = start + p
        if self._options.descent is Descent.DECADES:
            reached = regress(found, decades(FIRST_STEP * p, self._final), limit)
        else:
            reached = march_and_halve(found, MARCH_STEP * p, self._final, limit)
        if reached is None:
            raise Undecided("the edges do not enter the other part on the way down by a thread pitch")
        return pose(reached.place), reached.found

    def _turn(self, pose: Callable[[float], Floats], known: list[Touch], limit: float) -> Reached[Touches] | None:
        """The smallest turn (rad) at which edges enter elsewhere than in overlaps that were there before."""
        before = self._overlaps(pose(0.0))
        since = 0.0
        final = self._final / self._arm

        def found(turn: float) -> Touches | None:
            nonlocal before, since
            T_nut_bolt = pose(turn)
            overlaps = self._overlaps(T_nut_bolt)
            onsets = self._onsets(overlaps, before, T_nut_bolt, pose(turn + APPROACH_TURN))
            if not onsets:
                if turn - since > final and overlaps.sides > 1.1 * before.sides + JUMP_GROWTH:
                    return found(0.5 * (since + turn)) or found(turn)
                before, since = overlaps, turn
                return None
            if any(np.linalg.norm(one.point - old.point) < TOO_NEAR * self._side for one in onsets for old in known):
                raise Undecided("a contact appears within two sides of an earlier one: too near for these curves")
            return onsets

        p = self._pair.thread_pitch
        if self._options.descent is Descent.DECADES:
            return regress(found, decades(FIRST_STEP * p / self._arm, final), limit)
        return march_and_halve(found, MARCH_STEP * p / self._arm, final, limit)

    def _onsets(self, overlaps: Runs, before: Runs, T_nut_bolt: Floats, later: Floats) -> Touches:
        """The contacts at runs that are apart from all those before, on both edges."""
        bolt_new = np.array([not self._bolt_edge.near(run, before.bolt, NEAR) for run in overlaps.bolt], dtype=bool)
        nut_new = np.array([not self._nut_edge.near(run, before.nut, NEAR) for run in overlaps.nut], dtype=bool)
        if not bolt_new.any() and not nut_new.any():
            return ()
        old = Runs(overlaps.bolt[~bolt_new], overlaps.nut[~nut_new])
        # An overlap that grows over the other part's edge comes to hold a run of that, too.
        bolt = [run for run in overlaps.bolt[bolt_new] if not self._beside(run, old.nut, T_nut_bolt)]
        nut = [run for run in overlaps.nut[nut_new] if not any(self._beside(r, [run], T_nut_bolt) for r in old.bolt)]
        touches = self._touches_of(Runs(np.reshape(bolt, (-1, 2)), np.reshape(nut, (-1, 2))), T_nut_bolt)
        return _by_azimuth([one for one in touches if self._closes(one, T_nut_bolt, later)])

    def _beside(self, bolt_run: Floats, nut_runs: Iterable[Floats], T_nut_bolt: Floats) -> bool:
        """Whether a run of the bolt's edge is within a side of one of the nut's."""
        return any(
            distance(self._bolt_edge, bolt_run, self._nut_edge, run, T_nut_bolt) < NEAR * self._side for run in nut_runs
        )

    def _touches_of(self, runs: Runs, T_nut_bolt: Floats) -> list[Touch]:
        """A contact a run; runs of both edges beside each other are one contact of edge on edge."""
        touches = []
        left = list(runs.nut)
        for run in runs.bolt:
            apart = [other for other in left if not self._beside(run, [other], T_nut_bolt)]
            touches.append(self._of_bolt_edge(float(run.mean()), len(apart) < len(left), T_nut_bolt))
            left = apart
        return touches + [self._of_nut_edge(float(run.mean()), T_nut_bolt) for run in left]

    def _of_bolt_edge(self, place: float, beside: bool, T_nut_bolt: Floats) -> Touch:
        point = apply(T_nut_bolt, self._bolt_edge.point(place))
        features = self._features(-float(point[2]), self._nut_edge.thread_depth(point), beside)
        pair = {None: stage.EDGE_EDGE, True: stage.EDGE_SURFACE, False: stage.EDGE_THREAD}[features]
        return Touch(NO_PAIRS, pair, point)

    def _of_nut_edge(self, place: float, T_nut_bolt: Floats) -> Touch:
        point = self._nut_edge.point(place)
        at_bolt = apply(inverse(T_nut_bolt), point)
        features = self._features(float(at_bolt[2]), self._bolt_edge.thread_depth(at_bolt), False)
        pair = {None: stage.EDGE_EDGE, True: stage.BASE_EDGE, False: stage.THREAD_EDGE}[features]
        return Touch(NO_PAIRS, pair, point)

    def _features(self, behind_cut: float, within_thread: float, beside: bool) -> bool | None:
        """Whether the edge enters by the other part's cut end (or else its thread); None: by its edge."""
        if beside or max(behind_cut, within_thread) < AT_THE_EDGE * (self.edge_deviation + self._final):
            return None
        return behind_cut < within_thread

    def _closes(self, one: Touch, T_nut_bolt: Floats, later: Floats) -> bool:
        """Whether a contact begins a new overlap.

        Its normal is that of the face in contact, or the vector product of two edges; an edge touches first with its
        tip only where the normal is between those of its two faces: elsewhere a face of it is inside already. Beyond a
        part's far end there is no thread.
        """
        at_bolt = apply(inverse(T_nut_bolt), one.point)
        p = self._pair.thread_pitch
        if at_bolt[2] > p or one.point[2] < -p:
            return False
        turn = T_nut_bolt[:3, :3]
        bolt = [turn @ normal for normal in (self._bolt_edge.cut_normal, self._bolt_edge.thread_normal(at_bolt))]
        nut = [self._nut_edge.cut_normal, self._nut_edge.thread_normal(one.point)]
        if one.features == stage.EDGE_EDGE:
            normal = np.cross(np.cross(bolt[0], bolt[1]), np.cross(nut[0], nut[1]))
            normal *= np.sign(normal @ (nut[0] + nut[1])) / np.linalg.norm(normal)
        else:
            normal = {
                stage.EDGE_SURFACE: nut[0],
                stage.EDGE_THREAD: nut[1],
                stage.BASE_EDGE: -bolt[0],
                stage.THREAD_EDGE: -bolt[1],
            }[one.features]
        moved = apply(later, at_bolt) - one.point
        by_bolt = one.features in (stage.BASE_EDGE, stage.THREAD_EDGE) or is_between(-normal, *bolt)
        by_nut = one.features in (stage.EDGE_SURFACE, stage.EDGE_THREAD) or is_between(normal, *nut)
        return bool(by_bolt and by_nut and normal @ moved < 0.0)

    def _collides(self, T_nut_bolt: Floats) -> bool:
        return self._overlaps(T_nut_bolt).sides > 0.0


def is_between(normal: Floats, one: Floats, other: Floats) -> bool:
    """Whether a unit vector, put into the plane of two others, is between them."""
    cosine = float(one @ other)
    along = float(normal @ one), float(normal @ other)
    return along[0] >= cosine * along[1] and along[1] >= cosine * along[0]


def _by_azimuth(touches: list[Touch]) -> Touches:
    return tuple(sorted(touches, key=lambda one: math.atan2(one.point[1], one.point[0]) % (2.0 * math.pi)))
