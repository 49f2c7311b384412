"""Contact states with arbitrary contents, for tests of what carries them."""

from __future__ import annotations

from hypothesis import strategies as st

from threadstate.library.grid import Grid
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, StagePose, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
"""Every double that can be stored, with subnormals and -0.0."""

VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)

CONTACTS = st.builds(
    Contact,
    stage=st.integers(1, 3),
    point=VECTORS,
    point_bolt=VECTORS,
    normal=VECTORS,
    bolt_region=st.sampled_from(BOLT_REGIONS),
    nut_region=st.sampled_from(NUT_REGIONS),
    features=st.sampled_from(FeaturePair),
    bolt_margin=NUMBERS,
    nut_margin=NUMBERS,
)


def states_at(roll_deg: float, pitch_deg: float, phase_deg: float) -> st.SearchStrategy[ContactState]:
    """States of one pose with anything in them."""
    return st.builds(
        ContactState,
        roll_deg=st.just(roll_deg),
        pitch_deg=st.just(pitch_deg),
        phase_deg=st.just(phase_deg),
        state_class=st.sampled_from(StateClass),
        flags=st.lists(st.sampled_from(Flag), unique=True).map(tuple),
        poses=st.lists(st.builds(StagePose, st.tuples(VECTORS, VECTORS, VECTORS), VECTORS), max_size=3).map(tuple),
        lambda_deg=st.none() | NUMBERS,
        mu_deg=st.none() | NUMBERS,
        drop=st.none() | NUMBERS,
        embedment=st.none() | NUMBERS,
        pivot_offset=st.none() | NUMBERS,
        drop_margin=st.none() | NUMBERS,
        embedment_margin=st.none() | NUMBERS,
        pivot_margin=st.none() | NUMBERS,
        contacts=st.lists(CONTACTS, max_size=4).map(tuple),
    )


def orientation_states(grid: Grid, index: int) -> st.SearchStrategy[list[ContactState]]:
    """The states of one orientation of a grid, with anything in them."""
    return st.tuples(*(states_at(*pose) for pose in grid.poses(index))).map(list)


def plain_state(roll_deg: float = 1.0, pitch_deg: float = -2.0, phase_deg: float = 30.0) -> ContactState:
    """A state in which every number is another one."""
    return ContactState(
        roll_deg=roll_deg,
        pitch_deg=pitch_deg,
        phase_deg=phase_deg,
        state_class=StateClass.STABLE_THREE_POINT,
        flags=(Flag.TIE,),
        poses=(StagePose(((1.0, 0.0, 0.25), (0.5, 1.0, 0.75), (0.125, 0.375, 1.0)), (0.01, 0.02, 0.03)),),
        lambda_deg=1.5,
        mu_deg=None,
        drop=0.001,
        embedment=0.002,
        pivot_offset=0.003,
        drop_margin=-0.001,
        embedment_margin=0.004,
        pivot_margin=0.005,
        contacts=(
            Contact(
                stage=1,
                point=(0.1, 0.2, 0.3),
                point_bolt=(0.4, 0.5, 0.6),
                normal=(0.0, 0.6, 0.8),
                bolt_region=BOLT_REGIONS[4],
                nut_region=NUT_REGIONS[8],
                features=FeaturePair.EDGE_SURFACE,
                bolt_margin=0.007,
                nut_margin=0.008,
            ),
        ),
    )
