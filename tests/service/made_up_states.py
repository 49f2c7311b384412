"""States that no bolt has: every class, flag, region and absence, for tests of what is stored and served."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence

from threadstate.state.model import Answer, Contact, ContactState, FeaturePair, Flag, StagePose, StateClass, Vector
from threadstate.statics.stored import StoredStatics
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS


def made_up_state(roll_deg: float, pitch_deg: float, phase_deg: float) -> ContactState:
    """A state that depends on its pose alone; some lengths are equal among states, some absent."""
    rng = random.Random(f"{roll_deg} {pitch_deg} {phase_deg}")
    reached = rng.choice((1, 2, 3, 3, 3))
    lengths = [rng.choice((0.0, 0.001, rng.uniform(0.0, 0.01))) for _ in range(3)]
    second, third = reached >= 2, reached == 3
    return ContactState(
        roll_deg=roll_deg,
        pitch_deg=pitch_deg,
        phase_deg=phase_deg,
        state_class=rng.choice(list(StateClass)),
        flags=tuple(flag for flag in Flag if rng.random() < 0.2),
        poses=tuple(_pose(rng) for _ in range(reached)),
        lambda_deg=rng.choice((1.0, rng.uniform(0.0, 45.0))) if second else None,
        mu_deg=rng.choice((2.0, rng.uniform(0.0, 45.0))) if third else None,
        drop=lengths[0] if third else None,
        embedment=lengths[1] if third else None,
        pivot_offset=lengths[2] if second else None,
        drop_margin=lengths[0] - lengths[1] if third else None,
        embedment_margin=-lengths[1] if third else None,
        pivot_margin=lengths[2] - 0.0125 if second else None,
        contacts=tuple(_contact(rng, min(1 + i, reached)) for i in range(reached + rng.choice((0, 0, 1)))),
    )


def made_up_states(poses: Iterable[tuple[float, float, float]]) -> list[ContactState]:
    """A state for each pose."""
    return [made_up_state(*pose) for pose in poses]


def made_up_statics(first: int, answers: Sequence[Answer]) -> dict[int, StoredStatics | None]:
    """Statics that depend on the ordinal alone, ordinals beginning with ``first``; some are equal, some absent."""
    return {ordinal: _statics(random.Random(ordinal)) for ordinal in range(first, first + len(answers))}


def _statics(rng: random.Random) -> StoredStatics | None:
    margin, hold, wedge = (rng.choice((0.25, rng.uniform(0.0, 0.5), None)) for _ in range(3))
    return None if margin is None else StoredStatics(margin - 0.25, hold, wedge)


def _pose(rng: random.Random) -> StagePose:
    return StagePose((_vector(rng), _vector(rng), _vector(rng)), _vector(rng))


def _contact(rng: random.Random, stage: int) -> Contact:
    return Contact(
        stage=stage,
        point=_vector(rng),
        point_bolt=_vector(rng),
        normal=_vector(rng),
        bolt_region=rng.choice(BOLT_REGIONS),
        nut_region=rng.choice(NUT_REGIONS),
        features=rng.choice(list(FeaturePair)),
        bolt_margin=rng.uniform(0.0, 0.01),
        nut_margin=rng.uniform(0.0, 0.01),
    )


def _vector(rng: random.Random) -> Vector:
    return rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)
