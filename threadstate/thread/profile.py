"""The profile ``f`` of one thread: radius against axial position, in closed form (method, section 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import TYPE_CHECKING

from threadstate.errors import ImpossibleThreadError, InvalidValueError
from threadstate.thread.form import check_flanks, flank_half_angles
from threadstate.thread.hand import MOST_STARTS, Hand

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


SHARPEST = 4e-9
"""Over the thread pitch, the fillet that stands for a sharp corner: heights are within a quarter of it."""


@dataclass(frozen=True)
class Profile:
    """A thread's profile: flat, tangent fillet, straight flank, tangent fillet, flat, per half period.

    All lengths are in the pair's unit. ``s`` is the axial position of the profile; ``f`` has period
    ``thread_pitch`` and meets the pitch radius at s = 0 with the radius growing, at s = p/2 with the radius falling.
    Where both flanks have one angle it is largest at s = p/4 and smallest at s = 3p/4.

    Raises:
        ImpossibleThreadError: a dimension is not finite or not positive, the diameters are not
            ordered, or the fillets do not fit.
    """

    thread_pitch: float
    minor_diameter: float
    pitch_diameter: float
    major_diameter: float
    flank_half_angle_deg: float
    minor_fillet_radius: float
    major_fillet_radius: float
    starts: int = 1
    hand: Hand = Hand.RIGHT
    flank_half_angle_neg_deg: float | None = None

    def __post_init__(self) -> None:
        for name in ("thread_pitch", "minor_diameter", "pitch_diameter", "major_diameter"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ImpossibleThreadError(name, value, "a finite length > 0")
        for name in ("minor_fillet_radius", "major_fillet_radius"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise ImpossibleThreadError(name, value, "a finite length >= 0")
        if self.starts not in range(1, MOST_STARTS + 1):
            raise ImpossibleThreadError("starts", self.starts, f"a whole number, 1 to {MOST_STARTS}")
        check_flanks(self.flank_half_angle_deg, self.flank_half_angle_neg_deg)
        if not self.minor_diameter < self.pitch_diameter < self.major_diameter:
            raise ImpossibleThreadError(
                "pitch_diameter",
                self.pitch_diameter,
                f"between minor diameter {self.minor_diameter!r} and major diameter {self.major_diameter!r}",
            )
        halves = (self.boundaries, self.falling_boundaries)
        half = self.thread_pitch / 2.0
        slack = 1e-12 * self.thread_pitch
        if -sum(flat for flat, _, _, _ in halves) > half + 2.0 * slack:
            raise ImpossibleThreadError(
                "minor_fillet_radius",
                self.minor_fillet_radius,
                f"at most {self._largest_fillet(0)!r} (it must fit into the groove)",
            )
        if sum(top for _, _, _, top in halves) > half + 2.0 * slack:
            raise ImpossibleThreadError(
                "major_fillet_radius",
                self.major_fillet_radius,
                f"at most {self._largest_fillet(1)!r} (it must fit on the ridge)",
            )
        if any(flank > crest + slack for _, flank, crest, _ in halves):
            raise ImpossibleThreadError(
                "minor_fillet_radius",
                self.minor_fillet_radius,
                "small enough for the two fillets to leave a flank between them",
            )

    def __getstate__(self) -> dict[str, float]:
        # Without ``packed``: unpickled it would be writable, and kernels would be compiled again for such an array.
        return {name: value for name, value in vars(self).items() if name != "packed"}

    def _largest_fillet(self, which: int) -> float:
        """Of that at the small (0) or at the large (1) radius, the largest of which both tangents fit on the flat."""
        room = self.thread_pitch / 2.0 - sum(abs(_corners(self, half_angle)[which]) for half_angle in self.half_angles)
        return room / sum(math.tan((math.pi / 2.0 - half_angle) / 2.0) for half_angle in self.half_angles)

    @property
    def half_angles(self) -> tuple[float, float]:
        """Those of the positive and of the negative flank (rad)."""
        return flank_half_angles(self.flank_half_angle_deg, self.flank_half_angle_neg_deg)

    @property
    def boundaries(self) -> tuple[float, float, float, float]:
        """The ``s`` of flat | fillet | flank | fillet | flat on the rising half, in the pair's unit."""
        return self._boundaries(0, self.minor_fillet_radius, self.major_fillet_radius)

    @property
    def falling_boundaries(self) -> tuple[float, float, float, float]:
        """The same on the falling half, by p/2 - s."""
        return self._boundaries(1, self.minor_fillet_radius, self.major_fillet_radius)

    @property
    def ends(self) -> tuple[float, float]:
        """The ``s`` from and up to which the profile rises: the middles of its flats, -p/4 and p/4 where both flanks
        have one angle.
        """
        return self._ends(self.boundaries, self.falling_boundaries)

    def _boundaries(self, half: int, minor_fillet: float, major_fillet: float) -> tuple[float, float, float, float]:
        turn = math.pi / 2.0 - self.half_angles[half]
        low, high = _corners(self, self.half_angles[half])
        t_low = minor_fillet * math.tan(turn / 2.0)
        t_high = major_fillet * math.tan(turn / 2.0)
        return low - t_low, low + t_low * math.cos(turn), high - t_high * math.cos(turn), high + t_high

    def _ends(self, rising: tuple[float, ...], falling: tuple[float, ...]) -> tuple[float, float]:
        quarter = self.thread_pitch / 4.0
        return (rising[0] - falling[0]) / 2.0 - quarter, (rising[3] - falling[3]) / 2.0 + quarter

    @property
    def lead(self) -> float:
        """How far the thread's helix advances along the axis in a turn; negative of a left-hand thread."""
        return (1 if self.hand is Hand.RIGHT else -1) * self.starts * self.thread_pitch

    @property
    def advance(self) -> float:
        """The lead per radian, ``k`` in formulas."""
        return self.lead / (2.0 * math.pi)

    @cached_property
    def packed(self) -> NDArray[np.float64]:
        """The packed parameters that the kernels take, lengths in the pair's unit; read-only, shape (30,).

        A corner that is sharper than ``SHARPEST`` has that fillet.
        """
        import numpy as np

        least = SHARPEST * self.thread_pitch
        minor_fillet, major_fillet = max(self.minor_fillet_radius, least), max(self.major_fillet_radius, least)
        halves = [self._boundaries(half, minor_fillet, major_fillet) for half in range(2)]
        cots = [1.0 / math.tan(half_angle) for half_angle in self.half_angles]
        packed = np.array(
            [
                self.thread_pitch,
                self.minor_diameter / 2.0,
                self.pitch_diameter / 2.0,
                self.major_diameter / 2.0,
                minor_fillet,
                major_fillet,
                self.lead,
                max(cots),
                *self._ends(*halves),
                *self._half_numbers(halves[0], halves[1], cots[0], cots[1]),
                *self._half_numbers(halves[1], halves[0], cots[1], cots[0]),
                *_second_derivative_limits(max(cots), minor_fillet, major_fillet),
            ]
        )
        packed.setflags(write=False)
        return packed

    def _half_numbers(
        self, half: tuple[float, ...], other: tuple[float, ...], cot: float, other_cot: float
    ) -> tuple[float, ...]:
        """Those of a half period: its boundaries and cot; then, by u, how far its own f'' and the sign of f' reach.

        Past the middle of a flat the other half's fillet has the f'' of this one, as far from the flat, while both
        last: without end where both flanks have one angle. f' changes its sign where the other half's fillets begin.
        """
        (flat, flank, crest, top), half_pitch = half, 0.5 * self.thread_pitch
        reach_flat, reach_top = -half_pitch - other[0], half_pitch - other[3]
        far_flat, far_top = -math.inf, math.inf
        if cot != other_cot:
            far_flat = reach_flat - min(flank - flat, other[1] - other[0])
            far_top = reach_top + min(top - crest, other[3] - other[2])
        return flat, flank, cot, crest, top, far_flat, far_top, reach_flat, reach_top

    def radius(self, s: float) -> float:
        """``f(s)``: the radius at axial position ``s`` (any finite number), in the pair's unit."""
        return float(_kernel().radius(_finite(s), self.packed))

    def derivatives(self, s: float) -> tuple[float, float, float]:
        """``f, f', f''`` at ``s``, lengths in the pair's unit; between two regions f'' is the flat's or flank's."""
        r, d1, d2 = _kernel().jet(_finite(s), self.packed)
        return float(r), float(d1), float(d2)

    def inverse(self, r: float) -> float:
        """The ``s`` of the rising half at which the radius is ``r``, both in the pair's unit.

        At the two extreme radii, where a whole flat has them, it is the end of the flat beside the fillet.

        Raises:
            InvalidValueError: ``r`` is outside the profile's radii.
        """
        return float(_kernel().inverse(self._radius(r), 0, self.packed))

    def falling_inverse(self, r: float) -> float:
        """The ``p/2 - s`` of the falling half at which the radius is ``r``, as :meth:`inverse` has the ``s``."""
        return float(_kernel().inverse(self._radius(r), _kernel().FALLING, self.packed))

    def _radius(self, r: float) -> float:
        low, high = self.minor_diameter / 2.0, self.major_diameter / 2.0
        if not low <= r <= high:
            raise InvalidValueError("radius", r, f"{low!r} to {high!r}")
        return float(r)

    def region_index(self, s: float) -> tuple[int, float]:
        """Index 0..7 of the region at ``s`` (0 the small-radius flat, growing with ``s``), and its margin.

        The margin is the arc length along the profile to the nearest boundary of the region.
        """
        index, margin = _kernel().region_index(_finite(s), self.packed)
        return int(index), float(margin)


def _corners(profile: Profile, half_angle: float) -> tuple[float, float]:
    """Where a straight flank of that angle (rad) would meet the two flats."""
    tangent = math.tan(half_angle)
    low = (profile.minor_diameter - profile.pitch_diameter) / 2.0 * tangent
    high = (profile.major_diameter - profile.pitch_diameter) / 2.0 * tangent
    return low, high


def _second_derivative_limits(steepest: float, minor_fillet: float, major_fillet: float) -> tuple[float, float]:
    """Smallest and largest f'': where the fillets meet the steeper flank."""
    square = 1.0 + steepest * steepest
    cube = square * math.sqrt(square)
    return -cube / major_fillet, cube / minor_fillet


def _kernel() -> ModuleType:
    """The compiled profile; a client reads pairs where numba is not installed, and so imports no NumPy either."""
    from threadstate.thread import _profile_kernel

    return _profile_kernel


def _finite(s: float) -> float:
    if not math.isfinite(s):
        raise InvalidValueError("s", s, "a finite length")
    return float(s)


def outline_is_convex(profile: Profile) -> bool:
    """Whether the outline that a cut across the axis leaves is convex, by a bound; False: or the bound does not say.

    The outline is r = f(-k theta). A polar curve is convex where r^2 + 2 r'^2 - r r'' >= 0. With k the advance,
    r'' = k^2 f'' is positive on the fillet at the small radius alone, and largest where it meets the flank; elsewhere
    the sum is positive. On that fillet with r = R + rho (1 - cos a), f' = tan a and f'' = 1 / (rho cos^3 a) the sum is
    at least R^2 - r k^2 / (rho cos^3 a), taken over steps of the angle a with r and f'' at each step's far end.
    """
    rho = profile.minor_fillet_radius
    if rho == 0.0:
        return False
    k = abs(profile.advance)
    small = profile.minor_diameter / 2.0
    full = math.pi / 2.0 - min(profile.half_angles)
    steps = 400
    for i in range(steps):
        near, far = full * i / steps, full * (i + 1) / steps
        r_near = small + rho * (1.0 - math.cos(near))
        r_far = small + rho * (1.0 - math.cos(far))
        bend = k * k / (rho * math.cos(far) ** 3)
        if r_near * r_near + 2.0 * (k * math.tan(near)) ** 2 - r_far * bend < 0.0:
            return False
    return True
