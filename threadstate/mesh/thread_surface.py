"""A thread's surface of one pitch as columns of vertices, cut along helices at chosen places of the profile.

Every vertex lies on the true surface. The columns stand where a helix leaves the thread at its ends, and between; so
the two outlines are cut wherever the profile is, and no triangle ends in a sliver beside them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from threadstate.mesh.presets import Tessellation
from threadstate.mesh.solid import Floats, Ints, strip
from threadstate.thread.hand import Hand
from threadstate.thread.profile import Profile

FEWEST_AROUND, FEWEST_ON_FILLET = 16, 2
FEWEST_ON_STRAIGHT = 2
MINOR_FILLET, FLANK, MAJOR_FILLET = 1, 2, 3
"""Numbers of the parts of a rising half profile that are no flats."""
NEAR_END = 0.3
"""Of a part of the pitch, the share of a step between two cuts that its columns' last step may be longer by."""
SHORTEST = 1e-9
"""Parts of a profile that are shorter than this many thread pitches (a fillet of radius 0, say) are not there."""


@dataclass(frozen=True, eq=False)
class ThreadSurface:
    """Vertices (n, 3), triangles (m, 3) with normals away from the axis, and the outlines' vertices by azimuth."""

    vertices: Floats
    triangles: Ints
    low: Ints
    high: Ints


def thread_surface(
    profile: Profile,
    z_low: float,
    tessellation: Tessellation,
    part_size: float,
    height: float | None = None,
    pitches: int = 1,
) -> ThreadSurface:
    """The surface from ``z_low`` up by ``height``, at most the thread pitch, or else by that many pitches.

    Lengths are in the pair's unit. The outline at ``z_low`` is cut wherever the profile is; that at the top, too, if it
    is whole pitches higher.
    """
    cuts = profile_cuts(profile, tessellation, part_size)
    places = _column_places(cuts, _around(profile, tessellation), profile.starts)
    columns = [_column(cuts, place, height, pitches) for place in places]
    counts = np.array([len(column) for column in columns])
    offsets = np.concatenate([[0], np.cumsum(counts)])
    radii = np.concatenate([_radii(profile, cuts, column) for column in columns])
    axial = [_axial(cuts, column) for column in columns]
    rise = pitches * profile.thread_pitch if height is None else height
    heights = np.concatenate([_heights(s, z_low, rise) for s in axial])
    offset = math.fmod(z_low, profile.thread_pitch)
    azimuths = np.repeat([2.0 * math.pi * (offset - s[0]) / profile.lead for s in axial], counts)
    vertices = np.column_stack([radii * np.cos(azimuths), radii * np.sin(azimuths), heights])

    triangles: list[tuple[int, int, int]] = []
    for i, column in enumerate(columns):
        after = (i + 1) % len(columns)
        # One turn on, the same helix is a lead lower.
        next_column = columns[after] - (profile.starts * (len(cuts) - 1) if after == 0 else 0)
        triangles += strip(column, next_column, int(offsets[i]), int(offsets[after]))
    faces, low, high = np.array(triangles, dtype=np.int64), offsets[:-1], offsets[1:] - 1
    if profile.hand is Hand.LEFT:
        # Columns follow each other clockwise.
        faces, low, high = faces[:, ::-1], low[::-1], high[::-1]
    return ThreadSurface(vertices, faces, low, high)


def outline(profile: Profile, tessellation: Tessellation, part_size: float) -> Floats:
    """The points at which a surface that begins at z = 0 is cut there, by growing azimuth; (n, 3), z = 0."""
    cuts = profile_cuts(profile, tessellation, part_size)
    s = _axial(cuts, np.array(_column_places(cuts, _around(profile, tessellation), profile.starts)))
    azimuths = -2.0 * math.pi * s / profile.lead
    radii = np.array([profile.radius(place) for place in s.tolist()])
    points = np.column_stack([radii * np.cos(azimuths), radii * np.sin(azimuths), np.zeros(len(s))])
    return points[np.argsort(azimuths % (2.0 * math.pi))]


def profile_cuts(profile: Profile, tessellation: Tessellation, part_size: float) -> Floats:
    """Axial positions over one period, from the middle of a groove to that of the next, at which the profile is cut;
    ascending.
    """
    p = profile.thread_pitch
    root, crest = profile.ends
    rising = _half_cuts(profile, 0, (root, *profile.boundaries, crest), tessellation, part_size)
    ends = (-p / 2 - root, *profile.falling_boundaries, p / 2 - crest)
    falling = _half_cuts(profile, 1, ends, tessellation, part_size)
    return np.array([*rising, *(p / 2 - u for u in reversed(falling[:-1]))])


def _half_cuts(
    profile: Profile, half: int, ends: tuple[float, ...], tessellation: Tessellation, part_size: float
) -> list[float]:
    """The cuts of a half period, 0 the rising one, by its coordinate s or p/2 - s; ``ends`` are those of its parts."""
    half_angle = profile.half_angles[half]
    fillets = {MINOR_FILLET: profile.minor_fillet_radius, MAJOR_FILLET: profile.major_fillet_radius}
    cuts = [ends[0]]
    for i, (a, b) in enumerate(pairwise(ends)):
        if b - cuts[-1] > SHORTEST * profile.thread_pitch:
            if i in fillets:
                chord = 0.5 * tessellation.chord_at(fillets[i], part_size) * profile.thread_pitch
                cuts += _fillet_cuts(i, a, b, math.pi / 2.0 - half_angle, fillets[i], chord)
            else:
                n = _flank_strips(profile, half_angle, b - a, tessellation) if i == FLANK else FEWEST_ON_STRAIGHT
                cuts += [a + (b - a) * k / n for k in range(1, n + 1)]
    cuts[-1] = ends[-1]
    return cuts


def _flank_strips(profile: Profile, half_angle: float, width: float, tessellation: Tessellation) -> int:
    """Strips on which the flank's twist stays below half the chord height.

    Between two columns and two helices the flank is a patch whose corners are not in a plane: a diagonal runs
    ``d_theta ds twist / 4`` beside it, twist being the mixed derivative of the surface along its normal.
    """
    slope = 1.0 / math.tan(half_angle)
    climb = abs(profile.lead) / (math.pi * profile.minor_diameter)
    twist = slope * slope * climb / math.sqrt(1.0 + slope * slope * (1.0 + climb * climb))
    d_theta = 2.0 * math.pi / _around(profile, tessellation)
    chord = 0.5 * tessellation.chord_height * profile.thread_pitch
    return max(FEWEST_ON_STRAIGHT, math.ceil(width * d_theta * twist / 4.0 / chord))


def _fillet_cuts(which: int, start: float, end: float, full: float, radius: float, chord: float) -> list[float]:
    """Cuts at equal angles of the arc, whose sagitta is half the chord height; the other half is for the way around."""
    n = max(FEWEST_ON_FILLET, math.ceil(full / _angle_of_chord(radius, chord)))
    if which == MINOR_FILLET:
        return [start + radius * math.sin(full * k / n) for k in range(1, n)] + [end]
    return [end - radius * math.sin(full * (n - k) / n) for k in range(1, n)] + [end]


def _around(profile: Profile, tessellation: Tessellation) -> int:
    """Segments of a full turn whose sagitta at the major radius is half the chord height."""
    chord = 0.5 * tessellation.chord_height * profile.thread_pitch
    return max(FEWEST_AROUND, math.ceil(2.0 * math.pi / _angle_of_chord(profile.major_diameter / 2.0, chord)))


def _angle_of_chord(radius: float, chord_height: float) -> float:
    """The angle (rad) of an arc that is ``chord_height`` high, at most a quarter turn."""
    return 2.0 * math.acos(1.0 - min(chord_height / radius, 1.0 - math.sqrt(0.5)))


def _column_places(cuts: Floats, around: int, starts: int) -> list[float]:
    """Where columns begin, as fractional indices of the cuts, descending: at every cut, and evenly between.

    They go round once, over as many periods of the profile as there are starts.
    """
    period = cuts[-1] - cuts[0]
    places = []
    for i in range(len(cuts) - 2, -1, -1):
        n = math.ceil((cuts[i + 1] - cuts[i]) / period * around / starts - 1e-9)
        places += [i + 1.0] + [i + 1.0 - k / n for k in range(1, n)]
    return [place - turn * (len(cuts) - 1) for turn in range(starts) for place in places]


def _column(cuts: Floats, place: float, height: float | None, pitches: int) -> Floats:
    """Fractional indices of a column's vertices over whole periods or a height, its two ends included; ascending."""
    if height is None:
        top = place + pitches * (len(cuts) - 1)
        last = math.ceil(top)
    else:
        top = _index(cuts, float(_axial(cuts, np.array([place]))[0]) + height)
        last = math.ceil(top - NEAR_END)
    inside = np.arange(math.floor(place) + 1, last, dtype=np.float64)
    return np.concatenate([[place], inside, [top]])


def _index(cuts: Floats, s: float) -> float:
    """The fractional index of an axial position: the inverse of :func:`_axial`."""
    turns = math.floor((s - cuts[0]) / (cuts[-1] - cuts[0]))
    within = np.interp(s - turns * (cuts[-1] - cuts[0]), cuts, np.arange(len(cuts)))
    return float(within) + turns * (len(cuts) - 1)


def _axial(cuts: Floats, column: Floats) -> Floats:
    """The axial position ``s`` of fractional indices."""
    period = len(cuts) - 1
    turns = np.floor(column / period)
    within = column - turns * period
    return np.asarray(np.interp(within, np.arange(period + 1.0), cuts) + turns * (cuts[-1] - cuts[0]))


def _radii(profile: Profile, cuts: Floats, column: Floats) -> Floats:
    inside = _profile_radii(profile, tuple(cuts.tolist()))
    low, high = (profile.radius(s) for s in _axial(cuts, column[[0, -1]]).tolist())
    within = column[1:-1].astype(np.int64) % (len(cuts) - 1)
    return np.concatenate([[low], inside[within], [high]])


@lru_cache(maxsize=8)
def _profile_radii(profile: Profile, cuts: tuple[float, ...]) -> Floats:
    return np.array([profile.radius(s) for s in cuts])


def _heights(s: Floats, z_low: float, rise: float) -> Floats:
    z = s - s[0] + z_low
    z[-1] = z_low + rise
    return z
