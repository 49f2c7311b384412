"""The numbers of a contact state that may be absent: each declared once, for tables, hashes, exports and sorting.

A new one is a field of :class:`threadstate.state.model.ContactState`, a line here, its place in the document
(:mod:`threadstate.state.document`) and in the client's model, and a migration.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number of a contact state, None where a stage that it needs was not reached.

    Attributes:
        attribute: its field in ``ContactState``, and its column in the table ``state``.
        name: its name in exports, and in the order of states where ``sortable``.
        is_length: a length in the unit of the state, else an angle in degrees.
        meaning: in words.
        sortable: whether states are sorted by it, with an index.
    """

    attribute: str
    name: str
    is_length: bool
    meaning: str
    sortable: bool


QUANTITIES = (
    Quantity("lambda_deg", "lambda", False, "second turn", sortable=True),
    Quantity("mu_deg", "mu", False, "third turn", sortable=True),
    Quantity("drop", "drop", True, "how far the bolt's origin sinks from the second pose to the third", sortable=True),
    Quantity(
        "embedment", "embedment", True, "least lift of the third pose after which nothing overlaps", sortable=True
    ),
    Quantity(
        "pivot_offset",
        "pivot_offset",
        True,
        "from the bolt's origin to the line through the first two contacts",
        sortable=True,
    ),
    Quantity("drop_margin", "margin_drop", True, "signed distance of the drop from its threshold", sortable=False),
    Quantity(
        "embedment_margin",
        "margin_embedment",
        True,
        "signed distance of the embedment from its threshold",
        sortable=False,
    ),
    Quantity(
        "pivot_margin",
        "margin_pivot_offset",
        True,
        "signed distance of the pivot offset from its threshold",
        sortable=False,
    ),
)
"""In the order in which they are stored, hashed and exported."""
