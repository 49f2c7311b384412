"""Every statement that is tested, with its measurement, in the order of the paper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from studies.paper.claim import Claim, Statement, claim
from studies.paper.measures import approaches, case_one, models, named_poses, orientations, other_cases, parts
from studies.paper.study import Measure, Study


@dataclass(frozen=True)
class Chapter:
    """A group of statements with their measurements."""

    title: str
    measured: tuple[tuple[Statement, Measure], ...]


CHAPTERS = (
    Chapter("The parts and the mesh (sections 3 and 4)", parts.MEASURED),
    Chapter("Positive roll (section 5, case 1; figures 6 and 7)", case_one.MEASURED),
    Chapter("Negative roll, and pitch (section 5, cases 2 to 4; figures 8 to 10)", other_cases.MEASURED),
    Chapter("The second and the third turn (sections 1 and 6)", models.MEASURED),
    Chapter("Eight approaches (sections 7 and 7.1)", approaches.MEASURED_OVER_ALL + approaches.MEASURED),
    Chapter("Three poses (sections 7.1.1 to 7.1.3; figures 19 to 21)", named_poses.MEASURED),
    Chapter("All orientations (sections 7, 7.2 and 8; figure 22)", orientations.MEASURED),
)


def statement_count() -> int:
    """How many statements are tested."""
    return sum(len(chapter.measured) for chapter in CHAPTERS)


def claims_by_chapter(study: Study, advance: Callable[[int], None]) -> tuple[tuple[Chapter, tuple[Claim, ...]], ...]:
    """Every chapter with its claims; ``advance`` is called with 1 after each claim."""
    found = []
    for chapter in CHAPTERS:
        claims = []
        for statement, measure in chapter.measured:
            claims.append(claim(statement, measure(study)))
            advance(1)
        found.append((chapter, tuple(claims)))
    return tuple(found)
