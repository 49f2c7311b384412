"""A contact state as JSON; apart from its document, so that a client needs no serialiser."""

from __future__ import annotations

import orjson

from threadstate.state.document import state_document
from threadstate.state.model import ContactState


def state_json(state: ContactState, length_factor: float = 1.0) -> bytes:
    """:func:`state_document` as one line of compact JSON; every double is its shortest decimal.

    Raises:
        InvalidValueError: a number of the state is not finite.
    """
    return orjson.dumps(state_document(state, length_factor))
