from __future__ import annotations

from dataclasses import replace
from itertools import product

from hypothesis import given
from hypothesis import strategies as st

from tests.library.states import plain_state
from threadstate.network.from_history import class_margin, smallest_margin
from threadstate.state.classify import classify
from threadstate.state.model import Flag, StateClass

Margins = tuple[float, float, float]
margins = st.tuples(*(st.integers(-4, 4).map(float),) * 3)


def class_of(of_drop: float, of_embedment: float, of_pivot: float) -> StateClass:
    """The class of a state with these class margins."""
    return classify(
        flush=False,
        third=True,
        drop=of_drop,
        embedment=0.0,
        pivot_offset=of_pivot,
        pivot_threshold=0.0,
        embedment_tolerance=of_embedment,
    ).state_class


def classes_around(values: Margins, change: float) -> set[StateClass]:
    """The classes when each margin grows by so much, shrinks by it or stays."""
    return {
        class_of(*(value + sign * change for value, sign in zip(values, signs, strict=True)))
        for signs in product((-1.0, 0.0, 1.0), repeat=3)
    }


@given(margins)
def test_less_than_the_margin_keeps_the_class_and_more_does_not(values: Margins) -> None:
    drop, embedment, pivot = values
    state_class = class_of(*values)
    state = replace(
        plain_state(),
        flags=(),
        state_class=state_class,
        drop_margin=drop,
        embedment_margin=embedment,
        pivot_margin=pivot,
    )
    margin = class_margin(state)
    assert margin is not None
    assert margin >= 0.0
    if margin > 0.0:
        assert classes_around(values, margin - 0.5) == {state_class}
    assert len(classes_around(values, margin + 0.5)) > 1


def test_the_smallest_margin_is_that_of_a_region_or_of_the_class() -> None:
    state = replace(plain_state(), flags=(), state_class=StateClass.STABLE_THREE_POINT)
    contact = replace(state.contacts[0], bolt_margin=3.0, nut_margin=2.0)
    state = replace(state, contacts=(contact,), drop_margin=1.0, embedment_margin=-5.0, pivot_margin=7.0)
    assert smallest_margin(state) == class_margin(state) == 1.0
    assert smallest_margin(replace(state, drop_margin=4.0)) == 2.0
    assert smallest_margin(replace(state, contacts=(replace(contact, bolt_margin=0.5),))) == 0.5


def test_a_class_that_stands_on_no_length_has_no_margin() -> None:
    state = replace(plain_state(), flags=())
    for without in (
        replace(state, flags=(Flag.FLUSH,)),
        replace(state, flags=(Flag.NO_THIRD,), drop=None, drop_margin=None),
    ):
        assert class_margin(without) is None
        assert smallest_margin(without) == min(m for c in state.contacts for m in (c.bolt_margin, c.nut_margin))
    assert smallest_margin(None) is None
