"""What the page says of the printed angles."""

from __future__ import annotations

from studies.stability.findings import Findings
from studies.stability.table import table
from studies.stability.tangent_study import WRONG_DEG, is_wrong


def angles_text(found: Findings) -> str:
    """How often each printed equation is off."""
    poses = [pose.directions for row in found.rows for pose in row.poses]
    shares = []
    for equation, errors in (
        ("Eq. 7 (tangent, nut's frame)", [one.nut_tangent for one in poses]),
        ("Eq. 9 (tangent, bolt's frame)", [one.bolt_tangent for one in poses]),
        ("Eq. 11 (pivot axis, contact's frame)", [one.pivot_axis for one in poses]),
    ):
        known = [error for error in errors if error is not None]
        none = sum(error != error for error in known)
        shares.append(
            f"- {equation}: off by more than {WRONG_DEG:g} deg in {sum(map(is_wrong, known)):,} of {len(known):,} "
            f"poses of the grid, of which {none:,} have no number at all."
        )
    return (
        "The paper turns the x axis into a tangent by `acos(x / sin(acos z))` about z. That loses the sign of the y "
        "part, half of the digits beside +-x, and everything beside +-z, where it divides by zero. `atan2(y, x)` and "
        "`-atan2(z, hypot(x, y))` do not; the project uses neither pair of angles but the vectors themselves.\n\n"
        + "\n".join(shares)
        + "\n\nBeside each axis, 16 directions at each of the angles 0, 1e-16, 1e-12, 1e-8, 1e-4 and 0.01 rad from it:"
    )


def axes_table(found: Findings) -> str:
    """Both formulas beside the six axes."""
    head = ("axis", "directions", "no number", f"off by more than {WRONG_DEG:g} deg", "largest error, printed (deg)")
    return table(
        (*head, "largest error, atan2 (deg)"),
        [
            (
                one.axis,
                f"{one.directions}",
                f"{one.without_number}",
                f"{one.wrong}",
                f"{one.printed_deg:.2g}",
                f"{one.two_argument_deg:.1e}",
            )
            for one in found.axes
        ],
    )
