from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from enum import StrEnum

import pytest
from hypothesis import given

from tests.library.states import plain_state, states_at
from threadstate.errors import InvalidValueError
from threadstate.library.fingerprint import answers_sha256, library_sha256, state_bytes
from threadstate.state.model import ContactState


def _changed(value: object) -> Iterator[object]:
    """Everything that differs from ``value`` in one place."""
    if is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            for changed in _changed(getattr(value, field.name)):
                yield replace(value, **{field.name: changed})
    elif isinstance(value, StrEnum):
        yield next(name for name in type(value) if name is not value)
    elif isinstance(value, tuple):
        for place, part in enumerate(value):
            for changed in _changed(part):
                yield (*value[:place], changed, *value[place + 1 :])
        if not all(isinstance(part, float) for part in value):
            yield value[:-1]
    elif isinstance(value, int):
        yield value + 1
    elif isinstance(value, float):
        yield math.nextafter(value, math.inf)
        yield -value if value else 1.0
    else:
        yield 0.0


def test_every_single_change_of_a_state_changes_its_bytes() -> None:
    state = plain_state()
    variants = [variant for variant in _changed(state) if isinstance(variant, ContactState)]
    contents = {state_bytes(variant) for variant in variants}
    assert len(variants) > 60
    assert len(contents) == len(set(variants))
    assert state_bytes(state) not in contents


@given(states_at(1.0, 2.0, 3.0), states_at(1.0, 2.0, 3.0))
def test_states_have_the_same_bytes_exactly_where_they_are_equal(one: ContactState, other: ContactState) -> None:
    assert (state_bytes(one) == state_bytes(other)) == (one == other)


def test_minus_zero_counts_as_zero() -> None:
    assert state_bytes(replace(plain_state(), drop=-0.0)) == state_bytes(replace(plain_state(), drop=0.0))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(value: float) -> None:
    state = plain_state()
    with pytest.raises(InvalidValueError):
        state_bytes(replace(state, drop=value))
    with pytest.raises(InvalidValueError):
        state_bytes(replace(state, contacts=(replace(state.contacts[0], point=(0.0, value, 0.0)),)))


def test_numbers_too_large_to_be_summed_are_finite_all_the_same() -> None:
    largest = math.nextafter(math.inf, 0.0)
    state = replace(plain_state(), drop=largest, embedment=largest, pivot_offset=largest)
    assert len(state_bytes(state)) == len(state_bytes(plain_state()))


def test_the_order_of_states_and_of_chunks_counts() -> None:
    one, other = plain_state(phase_deg=0.0), plain_state(phase_deg=1.0)
    assert answers_sha256([one, other]) != answers_sha256([other, one])
    assert library_sha256(["a", "b"]) != library_sha256(["b", "a"])
