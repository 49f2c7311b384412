"""The profile ``f`` of one thread: radius against axial position, in closed form (method, section 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import TYPE_CHECKING

from threadstate.errors import ImpossibleThreadError, InvalidValueError
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
    ``thread_pitch``, is largest at s = p/4 and smallest at s = 3p/4, and meets the pitch radius at s = 0
    with the radius growing.

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
        if not 0.0 < self.flank_half_angle_deg < 90.0:
            raise ImpossibleThreadError("flank_half_angle_deg", self.flank_half_angle_deg, "0 < angle < 90 deg")
        if not self.minor_diameter < self.pitch_diameter < self.major_diameter:
            raise ImpossibleThreadError(
                "pitch_diameter",
                self.pitch_diameter,
                f"between minor diameter {self.minor_diameter!r} and major diameter {self.major_diameter!r}",
            )
        flat, flank, crest, top = self.boundaries
        quarter = self.thread_pitch / 4.0
        slack = 1e-12 * self.thread_pitch
        if flat < -quarter - slack:
            raise ImpossibleThreadError(
                "minor_fillet_radius",
                self.minor_fillet_radius,
                f"at most {self._largest_fillet(-1)!r} (it must fit beside the axis of the groove)",
            )
        if top > quarter + slack:
            raise ImpossibleThreadError(
                "major_fillet_radius",
                self.major_fillet_radius,
                f"at most {self._largest_fillet(+1)!r} (it must fit beside the axis of the ridge)",
            )
        if flank > crest + slack:
            raise ImpossibleThreadError(
                "minor_fillet_radius",
                self.minor_fillet_radius,
                "small enough for the two fillets to leave a flank between them",
            )

    def __getstate__(self) -> dict[str, float]:
        # Without ``packed``: unpickled it would be writable, and kernels would be compiled again for such an array.
        return {name: value for name, value in vars(self).items() if name != "packed"}

    def _largest_fillet(self, side: int) -> float:
        half_angle = math.radians(self.flank_half_angle_deg)
        apex = self._corners[0 if side < 0 else 1]
        room = self.thread_pitch / 4.0 - abs(apex)
        return room / math.tan((math.pi / 2.0 - half_angle) / 2.0)

    @property
    def _corners(self) -> tuple[float, float]:
        """Where the straight flank would meet the two flats."""
        tangent = math.tan(math.radians(self.flank_half_angle_deg))
        low = (self.minor_diameter - self.pitch_diameter) / 2.0 * tangent
        high = (self.major_diameter - self.pitch_diameter) / 2.0 * tangent
        return low, high

    @property
    def boundaries(self) -> tuple[float, float, float, float]:
        """The ``s`` of flat | fillet | flank | fillet | flat on the rising half, -p/4 .. p/4, in the pair's unit."""
        return self._boundaries(self.minor_fillet_radius, self.major_fillet_radius)

    def _boundaries(self, minor_fillet: float, major_fillet: float) -> tuple[float, float, float, float]:
        turn = math.pi / 2.0 - math.radians(self.flank_half_angle_deg)
        low, high = self._corners
        t_low = minor_fillet * math.tan(turn / 2.0)
        t_high = major_fillet * math.tan(turn / 2.0)
        return low - t_low, low + t_low * math.cos(turn), high - t_high * math.cos(turn), high + t_high

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
        """The packed parameters that the kernels take, lengths in the pair's unit; read-only, shape (12,).

        A corner that is sharper than ``SHARPEST`` has that fillet.
        """
        import numpy as np

        least = SHARPEST * self.thread_pitch
        minor_fillet, major_fillet = max(self.minor_fillet_radius, least), max(self.major_fillet_radius, least)
        flat, flank, crest, top = self._boundaries(minor_fillet, major_fillet)
        cot = 1.0 / math.tan(math.radians(self.flank_half_angle_deg))
        packed = np.array(
            [
                self.thread_pitch,
                self.minor_diameter / 2.0,
                flat,
                flank,
                self.pitch_diameter / 2.0,
                cot,
                crest,
                top,
                self.major_diameter / 2.0,
                minor_fillet,
                major_fillet,
                self.lead,
            ]
        )
        packed.setflags(write=False)
        return packed

    def radius(self, s: float) -> float:
        """``f(s)``: the radius at axial position ``s`` (any finite number), in the pair's unit."""
        return float(_kernel().radius(_finite(s), self.packed))

    def derivatives(self, s: float) -> tuple[float, float, float]:
        """``f, f', f''`` at ``s``, lengths in the pair's unit; between two regions f'' is the flat's or flank's."""
        r, d1, d2 = _kernel().jet(_finite(s), self.packed)
        return float(r), float(d1), float(d2)

    def inverse(self, r: float) -> float:
        """The ``s`` in [-p/4, p/4] of the rising half at which the radius is ``r``, both in the pair's unit.

        At the two extreme radii, where a whole flat has them, it is the end of the flat beside the fillet.
        The falling half has the same radius at p/2 - s.

        Raises:
            InvalidValueError: ``r`` is outside the profile's radii.
        """
        low, high = self.minor_diameter / 2.0, self.major_diameter / 2.0
        if not low <= r <= high:
            raise InvalidValueError("radius", r, f"{low!r} to {high!r}")
        return float(_kernel().inverse_rising(r, self.packed))

    def region_index(self, s: float) -> tuple[int, float]:
        """Index 0..7 of the region at ``s`` (0 the small-radius flat, growing with ``s``), and its margin.

        The margin is the arc length along the profile to the nearest boundary of the region.
        """
        index, margin = _kernel().region_index(_finite(s), self.packed)
        return int(index), float(margin)


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
    full = math.pi / 2.0 - math.radians(profile.flank_half_angle_deg)
    steps = 400
    for i in range(steps):
        near, far = full * i / steps, full * (i + 1) / steps
        r_near = small + rho * (1.0 - math.cos(near))
        r_far = small + rho * (1.0 - math.cos(far))
        bend = k * k / (rho * math.cos(far) ** 3)
        if r_near * r_near + 2.0 * (k * math.tan(near)) ** 2 - r_far * bend < 0.0:
            return False
    return True
