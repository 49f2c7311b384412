"""The coordinates of a held bolt: the rotation vector from the commanded orientation, and the compliance centre.

Coordinates are ``q = (e, C)``: the bolt's rotation is ``R_cmd exp(e)``, and ``C`` is the compliance centre in the nut's
frame. Near a pose the bolt turns by a small ``w`` in its own axes, ``exp(e + d) = exp(e) exp(w)``, with
``w = J d + Q(d, d) / 2``. Contacts are differentiated by ``w`` first, which is simple, and then brought to ``e``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]

COORDINATES = 6

# What a device is in numbers: height of the compliance centre over the base, commanded rotation by rows, the commanded
# place of the centre, the scale of angles (a length), whether the twist is rigid (1 or 0), into how many parts the
# search of contacts divides an interval of an edge (``_places_kernel``), the stiffness by rows.
D_CENTRE = 0
D_ROTATION = 1
D_PLACE = 10
D_SCALE = 13
D_RIGID = 14
D_FINE = 15
D_STIFFNESS = 16
DEVICE_SIZE = D_STIFFNESS + 36

# A pose in numbers: rotation by rows, translation, compliance centre, J by rows, the four functions of the angle.
N_ROTATION, N_OFFSET, N_CENTRE, N_JACOBIAN, N_FUNCTIONS, N_VECTOR = 0, 9, 12, 15, 24, 28
PLACE_SIZE = 31

TERMS = 9
"""Terms of the series in the square of the angle; up to 1 rad the first one left out is below 1e-18."""


@kernel()
def angle_functions(angle2: float) -> tuple[float, float, float, float]:
    """``a = (1 - cos t) / t^2``, ``b = (t - sin t) / t^3``, ``a' / t`` and ``b' / t`` of the square of an angle."""
    a, b, a1, b1 = 0.0, 0.0, 0.0, 0.0
    term_a, term_b = 0.5, 1.0 / 6.0
    before_a, before_b = 0.0, 0.0
    for n in range(TERMS):
        a += term_a
        b += term_b
        if n > 0:
            # The derivative of c t^(2n) over t is 2 n c t^(2n - 2).
            a1 -= 2.0 * n * before_a / ((2 * n + 1) * (2 * n + 2))
            b1 -= 2.0 * n * before_b / ((2 * n + 2) * (2 * n + 3))
        before_a, before_b = term_a, term_b
        term_a *= -angle2 / ((2 * n + 3) * (2 * n + 4))
        term_b *= -angle2 / ((2 * n + 4) * (2 * n + 5))
    return a, b, a1, b1


@kernel()
def set_turn(x: float, y: float, z: float, u: float, v: float, turn: Array) -> None:
    """Sets ``I + u [e] + v [e]^2`` of a rotation vector e."""
    turn[0] = 1.0 - v * (y * y + z * z)
    turn[1] = v * x * y - u * z
    turn[2] = v * x * z + u * y
    turn[3] = v * x * y + u * z
    turn[4] = 1.0 - v * (x * x + z * z)
    turn[5] = v * y * z - u * x
    turn[6] = v * x * z - u * y
    turn[7] = v * y * z + u * x
    turn[8] = 1.0 - v * (x * x + y * y)


@kernel()
def set_place(q: Array, device: Array, place: Array) -> None:
    """Sets rotation, translation, centre and the chart's derivatives at coordinates ``q``."""
    x, y, z = q[0], q[1], q[2]
    angle2 = x * x + y * y + z * z
    a, b, a1, b1 = angle_functions(angle2)
    # exp(e) = I + s [e] + a [e]^2 with s = 1 - b t^2, and J = I - a [e] + b [e]^2.
    turn = place[N_JACOBIAN : N_JACOBIAN + 9]
    set_turn(x, y, z, 1.0 - b * angle2, a, turn)
    for i in range(3):
        for j in range(3):
            total = 0.0
            for m in range(3):
                total += device[D_ROTATION + 3 * i + m] * turn[3 * m + j]
            place[N_ROTATION + 3 * i + j] = total
    set_turn(x, y, z, -a, b, turn)
    for i in range(3):
        place[N_CENTRE + i] = q[3 + i]
        place[N_OFFSET + i] = q[3 + i] - device[D_CENTRE] * place[3 * i + 2]
        place[N_VECTOR + i] = q[i]
    place[N_FUNCTIONS] = a
    place[N_FUNCTIONS + 1] = b
    place[N_FUNCTIONS + 2] = a1
    place[N_FUNCTIONS + 3] = b1


@kernel()
def second_order(place: Array, i: int, j: int, out: Array) -> None:
    """Sets ``Q`` of two unit vectors of the coordinates ``e``: the second derivative of ``w`` there."""
    e = place[N_VECTOR : N_VECTOR + 3]
    b, a1, b1 = place[N_FUNCTIONS + 1], place[N_FUNCTIONS + 2], place[N_FUNCTIONS + 3]
    for m in range(3):
        out[m] = 0.0
    for order in range(2):
        first, other = (i, j) if order == 0 else (j, i)
        # e x unit(other)
        cx, cy, cz = 0.0, 0.0, 0.0
        if other == 0:
            cy, cz = e[2], -e[1]
        elif other == 1:
            cx, cz = -e[2], e[0]
        else:
            cx, cy = e[1], -e[0]
        # e x (e x unit(other)), unit(first) x (e x unit(other))
        ccx, ccy, ccz = e[1] * cz - e[2] * cy, e[2] * cx - e[0] * cz, e[0] * cy - e[1] * cx
        fx, fy, fz = 0.0, 0.0, 0.0
        if first == 0:
            fy, fz = -cz, cy
        elif first == 1:
            fx, fz = cz, -cx
        else:
            fx, fy = -cy, cx
        along = e[first]
        out[0] += 0.5 * (-a1 * along * cx + b1 * along * ccx + b * fx)
        out[1] += 0.5 * (-a1 * along * cy + b1 * along * ccy + b * fy)
        out[2] += 0.5 * (-a1 * along * cz + b1 * along * ccz + b * fz)


@kernel()
def to_chart(place: Array, gradient: Array, hessian: Array, scratch: Array) -> None:
    """Brings a gradient and a Hessian by ``(w, C)`` to the coordinates ``(e, C)``, in place."""
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    second = scratch[0:3]
    rows = scratch[3:39]
    for i in range(3):
        for j in range(6):
            total = 0.0
            for m in range(3):
                total += jacobian[3 * m + i] * hessian[m, j]
            rows[6 * i + j] = total
    correction = scratch[39:48]
    for i in range(3):
        for j in range(3):
            second_order(place, i, j, second)
            correction[3 * i + j] = gradient[0] * second[0] + gradient[1] * second[1] + gradient[2] * second[2]
    for i in range(3):
        for j in range(3):
            total = correction[3 * i + j]
            for m in range(3):
                total += rows[6 * i + m] * jacobian[3 * m + j]
            hessian[i, j] = total
        for j in range(3, 6):
            hessian[i, j] = rows[6 * i + j]
            hessian[j, i] = rows[6 * i + j]
    x, y, z = gradient[0], gradient[1], gradient[2]
    for i in range(3):
        gradient[i] = jacobian[i] * x + jacobian[3 + i] * y + jacobian[6 + i] * z


@kernel()
def set_deviation(q: Array, device: Array, deviation: Array) -> None:
    """Sets the deviation from the command: the rotation vector, then the centre's shift."""
    for i in range(3):
        deviation[i] = q[i]
        deviation[3 + i] = q[3 + i] - device[D_PLACE + i]


@kernel()
def elastic_energy(q: Array, device: Array, gradient: Array) -> float:
    """The elastic energy, and sets its gradient by ``q``."""
    energy = 0.0
    for i in range(COORDINATES):
        total = 0.0
        for j in range(COORDINATES):
            shift = q[j] - (device[D_PLACE + j - 3] if j >= 3 else 0.0)
            total += device[D_STIFFNESS + 6 * i + j] * shift
        gradient[i] = total
        energy += 0.5 * total * (q[i] - (device[D_PLACE + i - 3] if i >= 3 else 0.0))
    return energy
