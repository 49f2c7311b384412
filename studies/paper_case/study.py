"""The paper's case turned by a compliant hand: which friction and stiffness assemble it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.model import Device, SettledFlag, default_device
from threadstate.thread.catalogue import quarter_twenty_unc

ROLL_DEG, PITCH_DEG, PHASE_DEG = 0.0, -4.0, 300.0
"""The command: the orientation is the paper's, the phase is one from which the snap is before the bolt."""
DEFAULT_TILT_STIFFNESS = 500.0
TILT_STIFFNESSES = (50.0, 500.0, 5000.0)
"""N mm/rad."""
DEFAULT_CENTRE = 0.0
CENTRES = (-5.0, 10.0)
"""Heights of the compliance centre over the base (mm)."""
LEAST_FRICTION, MOST_FRICTION = 0.02, 0.32
NARROW = 0.02
"""The critical friction is bracketed to this width, from doubled frictions between these."""
SHOWN_FRICTION = 0.02
"""Of the path with friction that is plotted."""


@dataclass(frozen=True)
class Ended:
    """How one path ended.

    Attributes:
        mu: friction.
        outcome: of the path.
        flags: why it is undecided.
        snap: phase of the snap (deg) and its depth (the pair's unit); None without one.
        points: how many the path has.
        last_phase_deg: phase of the last one, None without points.
    """

    mu: float
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    snap: tuple[float, float] | None
    points: int
    last_phase_deg: float | None

    @property
    def engages(self) -> bool:
        """Whether the bolt is in the thread."""
        return self.outcome is AssemblyOutcome.ENGAGED


@dataclass(frozen=True)
class Limit:
    """Where along the friction a device ceases to assemble: paths at ever closer frictions, sorted by friction."""

    held: Device
    paths: tuple[Ended, ...]

    @property
    def frictionless(self) -> Ended:
        """The path without friction."""
        return self.paths[0]

    @property
    def last_engaged(self) -> Ended | None:
        """The last path before the first one that does not engage; None: already that without friction does not."""
        before = None
        for path in self.paths:
            if not path.engages:
                return before
            before = path
        return before

    @property
    def first_other(self) -> Ended | None:
        """The first path that does not engage, None where all do."""
        return next((path for path in self.paths if not path.engages), None)


def device(*, k_tilt: float = DEFAULT_TILT_STIFFNESS, centre: float = DEFAULT_CENTRE) -> Device:
    """The default device with another tilt stiffness (N mm/rad) or compliance centre (mm)."""
    matrix = [list(row) for row in default_device().stiffness]
    matrix[0][0] = matrix[1][1] = k_tilt
    return replace(default_device(), stiffness=tuple(map(tuple, matrix)), centre=centre)


def path_of(held: Device, mu: float) -> AssemblyPath:
    """The path of the case; counter-clockwise until the snap, then clockwise."""
    return assemble_pose(quarter_twenty_unc(), ROLL_DEG, PITCH_DEG, PHASE_DEG, held, mu=mu)


def ended(path: AssemblyPath) -> Ended:
    """How a path ended."""
    snap = next((event for event in path.events if event.kind is PathEventKind.SNAP), None)
    return Ended(
        path.mu,
        path.outcome,
        path.flags,
        None if snap is None else (snap.phase_deg, snap.drop or math.nan),
        len(path.points),
        path.points[-1].phase_deg if path.points else None,
    )


def limit_of(held: Device, run: Callable[[Device, float], Ended], narrow: float = NARROW) -> Limit:
    """The critical friction of a device, bracketed: doubled until a path does not engage, then halved.

    ``run`` follows one path. Between the two frictions the outcome may change more than once; what is bracketed is a
    change from a path that engages to one that does not.
    """
    paths = [run(held, 0.0)]
    mu = LEAST_FRICTION
    while paths[-1].engages and mu <= MOST_FRICTION:
        paths.append(run(held, mu))
        mu *= 2.0
    if len(paths) > 1 and not paths[-1].engages:
        low, high = paths[-2].mu, paths[-1].mu
        while high - low > narrow:
            middle = run(held, 0.5 * (low + high))
            paths.append(middle)
            low, high = (middle.mu, high) if middle.engages else (low, middle.mu)
    return Limit(held, tuple(sorted(paths, key=lambda path: path.mu)))


def ended_path(held: Device, mu: float) -> Ended:
    """How the path of the case with this device ends."""
    return ended(path_of(held, mu))


def limit_of_device(held: Device) -> Limit:
    """The limit of a device, by the case's own paths."""
    return limit_of(held, ended_path)


def shown_paths() -> Sequence[AssemblyPath]:
    """The paths that are plotted: of the default device without friction, and with little."""
    return [path_of(device(), mu) for mu in (0.0, SHOWN_FRICTION)]
