"""Locating: which orientations and phases remain after labels of a state were observed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import fsum

from threadstate.errors import InvalidValueError
from threadstate.history.labels import ContactLabels
from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.statics.verdict import Verdict
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region


@dataclass(frozen=True, slots=True)
class ContactObservation:
    """What was observed of one contact; None is not observed.

    Raises:
        InvalidValueError: a stage or a region that no contact has.
    """

    stage: int | None = None
    bolt_region: Region | None = None
    nut_region: Region | None = None
    features: FeaturePair | None = None

    def __post_init__(self) -> None:
        if self.stage not in (None, 1, 2, 3):
            raise InvalidValueError("stage", self.stage, "1, 2 or 3")
        for name, region, regions in (
            ("bolt_region", self.bolt_region, BOLT_REGIONS),
            ("nut_region", self.nut_region, NUT_REGIONS),
        ):
            if region is not None and region not in regions:
                raise InvalidValueError(name, region.value, f"one of {', '.join(regions)}")

    def fits(self, contact: ContactLabels) -> bool:
        """Whether a contact has all that was observed."""
        return (
            self.stage in (None, contact.stage)
            and self.bolt_region in (None, contact.bolt_region)
            and self.nut_region in (None, contact.nut_region)
            and self.features in (None, contact.features)
        )


@dataclass(frozen=True, slots=True)
class Observation:
    """What was observed of a state; None, and what is not named, is not observed.

    Every one of ``contacts`` is another contact of the state: the first ones in its order if ``ordered``, else any.
    ``flags`` are all set, others may be as well. ``verdict`` is that of cells of a load.

    Raises:
        InvalidValueError: a number of contacts that is negative or less than the contacts that are described.
    """

    state_class: StateClass | None = None
    contact_count: int | None = None
    flags: frozenset[Flag] = frozenset()
    contacts: tuple[ContactObservation, ...] = ()
    ordered: bool = False
    verdict: Verdict | None = None

    def __post_init__(self) -> None:
        if self.contact_count is not None and self.contact_count < len(self.contacts):
            raise InvalidValueError("contact_count", self.contact_count, f"at least {len(self.contacts)}")

    def fits(self, cell: Cell) -> bool:
        """Whether a cell has all that was observed; an undecided one has nothing."""
        formation = cell.formation
        return (
            formation.state_class is not None
            and self.verdict in (None, cell.verdict)
            and self.state_class in (None, formation.state_class)
            and self.contact_count in (None, len(formation.contacts))
            and self.flags.issubset(cell.flags)
            and len(self.contacts) <= len(formation.contacts)
            and self._contacts_fit(formation.contacts)
        )

    def _contacts_fit(self, contacts: Sequence[ContactLabels]) -> bool:
        if self.ordered:
            return all(one.fits(contact) for one, contact in zip(self.contacts, contacts, strict=False))
        return _matched(self.contacts, contacts)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Phases of an orientation that have one formation.

    From ``start_deg`` in [0, 360) to ``end_deg``, above 360 where phase 0 lies between.
    """

    orientation: int
    start_deg: float
    end_deg: float
    formation: Formation


@dataclass(frozen=True, slots=True)
class Location:
    """What remains: stretches by orientation and phase.

    ``share`` is their phase as a part of that of all orientations, ``undecided_share`` the part in which the solver
    decides no state: what is there cannot be excluded by any observation.
    """

    stretches: tuple[Stretch, ...]
    share: float
    undecided_share: float

    @property
    def orientations(self) -> tuple[int, ...]:
        """The orientations that remain, ascending."""
        return tuple(sorted({stretch.orientation for stretch in self.stretches}))

    @property
    def width_by_formation(self) -> dict[Formation, float]:
        """The formations that remain, each with the phase in degrees that it covers, the widest first."""
        widths: dict[Formation, float] = {}
        for one in self.stretches:
            widths[one.formation] = widths.get(one.formation, 0.0) + one.end_deg - one.start_deg
        return dict(sorted(widths.items(), key=lambda item: (-item[1], item[0].key)))


def locate(cell_map: CellMap, observation: Observation) -> Location:
    """The orientations and phases at which a state has all that was observed."""
    remaining = [[cell for cell in cells if observation.fits(cell)] for cells in cell_map.cells]
    width = fsum(cell.width_deg for cells in remaining for cell in cells)
    undecided = fsum(cell.width_deg for cell in cell_map.all_cells if cell.formation.state_class is None)
    stretches = tuple(stretch for cells in remaining for stretch in _stretches(cells))
    return Location(stretches, width / cell_map.total_deg, undecided / cell_map.total_deg)


def _stretches(cells: list[Cell]) -> list[Stretch]:
    """The cells of an orientation, those that touch and have the same formation joined, by start."""
    joined: list[Stretch] = []
    for cell in cells:
        if joined and joined[-1].end_deg == cell.start_deg and joined[-1].formation == cell.formation:
            joined[-1] = replace(joined[-1], end_deg=cell.end_deg)
        else:
            joined.append(Stretch(cell.orientation, cell.start_deg, cell.end_deg, cell.formation))
    if len(joined) > 1 and _meet_at_phase_0(joined[-1], joined[0]):
        first = joined.pop(0)
        joined[-1] = replace(joined[-1], end_deg=first.end_deg + CIRCLE_DEG)
    return joined


def _meet_at_phase_0(last: Stretch, first: Stretch) -> bool:
    return last.end_deg == first.start_deg + CIRCLE_DEG and last.formation == first.formation


def _matched(observed: Sequence[ContactObservation], contacts: Sequence[ContactLabels]) -> bool:
    """Whether every observation can have a contact of its own that it fits."""
    if not observed:
        return True
    return any(
        observed[0].fits(contact) and _matched(observed[1:], [*contacts[:i], *contacts[i + 1 :]])
        for i, contact in enumerate(contacts)
    )
