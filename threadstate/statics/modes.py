"""Contact modes: every way in which contacts can open, stick or slide under a load (forces, section 3).

The bolt moves as if in a viscous medium with the metric of forces, section 5: its twist is the metric's inverse times
the sum of the load and the contacts' wrenches. With friction several motions, or rest and motion, may
satisfy Coulomb's law at every contact: all of them are found. Where contacts slide, their directions are the zeros of
trigonometric polynomials, the rest follows by linear algebra.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from threadstate.errors import InvalidValueError
from threadstate.state.model import ContactState, Flag, Vector
from threadstate.statics.load import Load, checked_friction
from threadstate.statics.scene import Scene, scene_of
from threadstate.statics.solve import ContactForce
from threadstate.statics.torus_roots import common_zeros, padded, times_cosine, times_sine
from threadstate.statics.wrench_cone import (
    RANK_TOLERANCE,
    carried,
    complement,
    contact_maps,
    deepest_forces,
    force_maps,
    least_forces,
    null_space,
    slacks,
)
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

MOST_CONTACTS = 3
MARGINAL = 1e-9
"""A mode whose conditions hold by less, over the load, is on the border to another one."""
RESIDUAL = 1e-10
"""Velocities into a contact or across its sliding, over the load and the forces, that count as none."""


class Motion(StrEnum):
    """What a contact does."""

    STICKS = "sticks"
    """The bolt's point there rests."""
    SLIDES = "slides"
    """It moves along the nut, and friction opposes it."""
    OPENS = "opens"
    """It leaves the nut, and no force acts."""


class ModeStatus(StrEnum):
    """What is known of a mode."""

    CONSISTENT = "consistent"
    MARGINAL = "marginal"
    """All conditions hold, one of them by less than round-off can tell."""
    UNDECIDED = "undecided"
    """The search for motions of this kind was given up: there may be some beside those listed."""


@dataclass(frozen=True, slots=True)
class ContactMode:
    """A motion of the bolt that is consistent with the load, or a kind of motion that is undecided.

    Attributes:
        contacts: what each does.
        angular, linear: the twist at the bolt's origin, in the nut's frame: a free bolt that a force of 1 N pushes
            through its origin has the linear velocity 1; the angular one is over the pair's unit of length. None of a
            kind that is undecided.
        forces: of all contacts; of those that stick those deepest in their cones.
        margin: the least of: normal forces and speeds of contacts that slide, normal velocities of those that open,
            distances of forces from the border of their friction cone where contacts stick; over the load, moments over
            the nominal radius. The last are not sought beyond ``mu / (1 + mu^2)``.
    """

    contacts: tuple[Motion, ...]
    status: ModeStatus
    angular: Vector | None
    linear: Vector | None
    forces: tuple[ContactForce, ...]
    margin: float | None


def contact_modes(
    pair: Pair, state: ContactState, load: Load | None = None, mu: float = 0.0
) -> tuple[ContactMode, ...]:
    """All contact modes of a state that are consistent with a load at a friction; see :class:`ContactMode`.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite, or the state has contacts whose modes are not enumerated: a
            patch, or more than three.
        UnresolvedPoseError: a contact has no certain normal.
    """
    checked_friction(mu)
    if not modes_are_enumerated(state):
        raise InvalidValueError("contacts", _contacts_of(state), "one to three contacts, at points")
    return modes_of(scene_of(pair, state, load or Load()), mu)


def modes_are_enumerated(state: ContactState) -> bool:
    """Whether the state has one to three contacts, none of them a patch or a strip."""
    return Flag.FLUSH not in state.flags and len(state.contacts) <= MOST_CONTACTS


def _contacts_of(state: ContactState) -> str:
    return "a patch" if Flag.FLUSH in state.flags else str(len(state.contacts))


@dataclass(frozen=True, slots=True)
class _Found:
    """A motion: twist (6) and forces (k, 3) along normal and tangents, for a load of size 1; its margin."""

    contacts: tuple[Motion, ...]
    twist: Floats
    forces: Floats
    margin: float


def modes_of(scene: Scene, mu: float) -> tuple[ContactMode, ...]:
    """All consistent contact modes of a scene of at most three contacts."""
    size = float(np.linalg.norm(scene.load))
    contacts = _Contacts(scene.points, scene.normals, scene.load / size, mu)
    modes = []
    for motions in product(Motion, repeat=len(scene.points)) if mu > 0.0 else ():
        found, complete = contacts.motions(motions)
        modes += [_mode(one, scene, size) for one in found]
        if not complete:
            modes.append(ContactMode(motions, ModeStatus.UNDECIDED, None, None, (), None))
    if mu == 0.0:
        modes = [_mode(contacts.motion_without_friction(), scene, size)]
    return tuple(modes)


def _mode(found: _Found, scene: Scene, size: float) -> ContactMode:
    vectors = size * np.einsum("kqc,kc->kq", force_maps(scene.points, scene.normals)[:, 3:], found.forces)
    forces = []
    for i, (force, normal) in enumerate(zip(vectors, scene.normals, strict=True)):
        along = float(force @ normal)
        forces.append(ContactForce(i + 1, along + 0.0, _vector(force - along * normal)))
    return ContactMode(
        contacts=found.contacts,
        status=ModeStatus.CONSISTENT if found.margin > MARGINAL else ModeStatus.MARGINAL,
        angular=_vector(size * found.twist[:3] / scene.radius),
        linear=_vector(size * found.twist[3:]),
        forces=tuple(forces),
        margin=found.margin,
    )


def _vector(values: Floats) -> Vector:
    x, y, z = (values + 0.0).tolist()
    return x, y, z


class _Contacts:
    """Contacts under a load of size 1; wrenches and twists are scaled so that the metric is that of space."""

    def __init__(self, points: Floats, normals: Floats, load: Floats, mu: float) -> None:
        self._load, self._mu = load, mu
        self._maps = force_maps(points, normals)
        self._cones = contact_maps(points, normals, mu)

    def motions(self, motions: tuple[Motion, ...]) -> tuple[list[_Found], bool]:
        """The motions of one kind, and whether these are certainly all."""
        sticking, sliding, opening = (_which(motions, one) for one in Motion)
        free = complement(np.concatenate([np.zeros((6, 0)), *self._maps[sticking]], axis=1))
        maps = np.einsum("qm,kqc->kmc", free, self._maps)
        angles, complete = _directions(maps[sliding], maps[opening, :, 0], free.T @ self._load, self._mu)
        found = [self._found(motions, free, maps, one) for one in angles]
        return [one for one in found if one is not None and one.margin >= -MARGINAL], complete

    def _found(self, motions: tuple[Motion, ...], free: Floats, maps: Floats, angles: Floats) -> _Found | None:
        """The motion in which contacts slide in given directions; None if they do not."""
        sticking, sliding, opening = (_which(motions, one) for one in Motion)
        along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        across = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        shares = np.column_stack([np.ones(len(along)), -self._mu * along])
        columns = np.einsum("smc,sc->ms", maps[sliding], shares)
        resting = np.concatenate([maps[sliding][:, :, 0], np.einsum("smc,sc->sm", maps[sliding][:, :, 1:], across)])
        load = free.T @ self._load
        normal = np.linalg.lstsq(resting @ columns, -resting @ load, rcond=RANK_TOLERANCE)[0]
        moving = load + columns @ normal
        if np.abs(resting @ moving).max(initial=0.0) > RESIDUAL * (1.0 + np.abs(normal).sum()):
            return None
        twist = free @ moving
        forces = np.zeros((len(motions), 3))
        forces[sliding] = normal[:, np.newaxis] * shares
        speeds = np.einsum("smc,sc,m->s", maps[sliding][:, :, 1:], along, moving)
        leaving = self._maps[opening, :, 0] @ twist
        margin = float(np.concatenate([normal, speeds, leaving, [math.inf]]).min())
        # A contact that slides at no speed sticks: it is found as one that does.
        if margin < -MARGINAL or speeds.min(initial=math.inf) <= MARGINAL:
            return None
        if sticking.any():
            held, depth = self._sticking(sticking, self._load - twist + carried(self._maps, forces))
            forces[sticking] = held
            margin = min(margin, depth)
        return _Found(motions, twist, forces, margin)

    def _sticking(self, sticking: NDArray[np.bool_], load: Floats) -> tuple[Floats, float]:
        """Forces (n, 3) of contacts that balance a load, and how far they are within their cones."""
        cones = self._cones[sticking]
        columns = np.concatenate(list(cones), axis=1)
        forces = deepest_forces(least_forces(columns, load), null_space(columns), 3).reshape(-1, 3)
        depth = float(slacks(forces).min()) * self._mu / (1.0 + self._mu * self._mu)
        return forces * (np.array([1.0, self._mu, self._mu]) / math.hypot(1.0, self._mu)), depth

    def motion_without_friction(self) -> _Found:
        """The only motion: the load's part that the contacts leave over."""
        best: _Found | None = None
        normals = self._maps[:, :, 0]
        for pressed in product([False, True], repeat=len(normals)):
            mask = np.array(pressed)
            forces = np.zeros((len(normals), 3))
            rays = normals[mask]
            forces[mask, 0] = np.linalg.lstsq(rays @ rays.T, -rays @ self._load, rcond=RANK_TOLERANCE)[0]
            twist = self._load + carried(self._maps, forces)
            velocities = np.einsum("kqc,q->kc", self._maps, twist)
            speeds = np.linalg.norm(velocities[:, 1:], axis=1)
            rests = mask & (speeds <= MARGINAL)
            if np.abs(velocities[mask, 0]).max(initial=0.0) > RESIDUAL * (1.0 + np.abs(forces).sum()):
                continue
            conditions = [forces[mask, 0], velocities[~mask, 0], speeds[mask & ~rests]]
            margin = float(np.concatenate(conditions).min())
            motions = tuple(
                Motion.OPENS if not on else Motion.STICKS if still else Motion.SLIDES
                for on, still in zip(mask.tolist(), rests.tolist(), strict=True)
            )
            if best is None or margin > best.margin:
                best = _Found(motions, twist, forces, margin)
        assert best is not None
        return best


def _which(motions: tuple[Motion, ...], motion: Motion) -> NDArray[np.bool_]:
    return np.array([one is motion for one in motions])


def _directions(maps: Floats, opening: Floats, load: Floats, mu: float) -> tuple[Floats, bool]:
    """Angles (n, s) in which s contacts may slide, from the first tangent on, and whether there are no others.

    Shapes: maps (s, m, 3), the normals' rows of contacts that open (o, m), load (m).
    """
    s, m, _ = maps.shape
    if s == 0:
        return np.zeros((1, 0)), True
    rests = complement(maps[:, :, 0].T)
    if rests.shape[1] != m - s:
        # What slides presses on itself without friction: forces of any size.
        return np.zeros((0, s)), False
    if m == s:
        return np.zeros((0, s)), True
    if m == s + 1:
        velocities = np.einsum("m,smc->sc", rests[:, 0], maps[:, :, 1:])
        if np.linalg.norm(velocities, axis=1).min() <= MARGINAL:
            return np.zeros((0, s)), False
        angles = np.arctan2(velocities[:, 1], velocities[:, 0])
        return np.array([angles, angles + math.pi]), True
    zeros = common_zeros(*_polynomials(maps, opening, rests, load, mu))
    return zeros.angles, zeros.complete


def _polynomials(
    maps: Floats, opening: Floats, rests: Floats, load: Floats, mu: float
) -> tuple[list[Floats], list[Floats]]:
    """Polynomials that are zero, and others of one sign, where s contacts slide in directions that fit.

    By Cramer's rule the normal forces that keep all normal velocities zero are quotients of determinants, and the twist
    times their denominator is a polynomial of degree 1 in each angle. It gives no velocity across a direction.
    """
    s, m, _ = maps.shape
    columns = np.stack([maps[:, :, 0], -mu * maps[:, :, 1], -mu * maps[:, :, 2]], axis=1)
    matrix = np.einsum("im,jcm->jic", maps[:, :, 0], columns)
    denominator = _determinant(matrix)
    right = np.zeros((s, 3))
    right[:, 0] = -(maps[:, :, 0] @ load)
    numerators = [_determinant(np.stack([right if i == j else matrix[i] for i in range(s)])) for j in range(s)]
    twist = denominator[..., np.newaxis] * load
    for j, numerator in enumerate(numerators):
        constant = np.expand_dims(np.take(numerator, 0, axis=j), (j, s))
        twist = twist + constant * columns[j].reshape([3 if i == j else 1 for i in range(s)] + [m])
    equations, signs = [], [padded(one) for one in (denominator, *numerators)]
    for j in range(s):
        first, second = twist @ maps[j, :, 1], twist @ maps[j, :, 2]
        equations.append(times_cosine(second, j) - times_sine(first, j))
        signs.append(times_cosine(first, j) + times_sine(second, j))
    signs += [padded(twist @ row) for row in opening]
    if rests.shape[1] == s:
        # Every such twist moves all contacts along their directions; this excludes zeros at which no forces do.
        along = np.einsum("mr,smc->src", rests, maps[:, :, 1:])
        rows = np.stack([np.zeros((s, s)), along[:, :, 1], -along[:, :, 0]], axis=2)
        equations.append(padded(_determinant(rows)))
    return equations, signs


def _determinant(columns: Floats) -> Floats:
    """The determinant of s columns (s, rows, 3), each of degree 1 in an angle of its own: shape (3, ...)."""
    s = len(columns)
    total = np.zeros((3,) * s)
    for order in permutations(range(s)):
        term = np.array((-1.0) ** sum(a > b for i, a in enumerate(order) for b in order[i + 1 :]))
        for j, row in enumerate(order):
            term = np.multiply.outer(term, columns[j, row])
        total += term
    return total
