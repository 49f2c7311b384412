"""The pairs that are known by their designation: the default one, and those of standard threads."""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum
from functools import lru_cache

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.pair import Pair
from threadstate.thread.standards.designation import EXAMPLES
from threadstate.thread.standards.pairs import standard_pair, standard_source
from threadstate.units import LengthUnit


class RootForm(StrEnum):
    """Which minor diameter of the bolt: 1.19078 p below the major, or as newer editions print it."""

    CLASSIC = "classic"
    NEWER = "newer"


DEFAULT_DESIGNATION = "1/4-20 UNC"

_BOLT_MINOR_DIAMETER = {RootForm.CLASSIC: 0.1894, RootForm.NEWER: 0.1876}
_DESIGNATION = {RootForm.CLASSIC: DEFAULT_DESIGNATION, RootForm.NEWER: f"{DEFAULT_DESIGNATION} newer root"}


def quarter_twenty_unc(root_form: RootForm = RootForm.CLASSIC) -> Pair:
    """1/4-20 UNC: bolt 2A at maximum material, nut 2B at minimum material, in inches (method, section 1)."""
    return Pair(
        designation=_DESIGNATION[root_form],
        unit=LengthUnit.INCH,
        nominal_diameter=0.25,
        thread_pitch=0.05,
        form=Form(
            name="UN",
            flank_half_angle_deg=30.0,
            bolt_root_fillet=0.108,
            bolt_crest_fillet=0.054,
            nut_root_fillet=0.054,
            nut_crest_fillet=0.108,
        ),
        fit=Fit(
            name="2A/2B",
            bolt_major_diameter=0.2489,
            bolt_pitch_diameter=0.2164,
            bolt_minor_diameter=_BOLT_MINOR_DIAMETER[root_form],
            nut_major_diameter=0.2500,
            nut_pitch_diameter=0.2175,
            nut_minor_diameter=0.1960,
        ),
    )


def pair_by_designation(designation: str) -> Pair:
    """The pair of that designation, in any case, with or without blanks round its parts.

    A standard thread is ``1/4-20 UNC-3A/3B``, ``M6`` or the like, with ``at minimum material`` or another position in
    its tolerances after it. The default pair has its own name however it is written.

    Raises:
        UnknownNameError: no such designation.
        InvalidValueError: a class that the form does not have, or a position that is none.
    """
    written = " ".join(designation.split()).upper()
    for root_form, name in _DESIGNATION.items():
        if written == name.upper():
            return quarter_twenty_unc(root_form)
    try:
        found = standard_pair(designation)
    except UnknownNameError as error:
        raise UnknownNameError(
            error.name, designation, f"{VALID_DESIGNATIONS}; `threadstate threads` lists them"
        ) from None
    default = quarter_twenty_unc()
    return default if replace(found, designation=default.designation) == default else found


VALID_DESIGNATIONS = f"a standard thread, such as {EXAMPLES}, or {_DESIGNATION[RootForm.NEWER]}"


@lru_cache(maxsize=256)
def source_of(pair: Pair) -> str | None:
    """On what the dimensions of a pair rest: its standard, and how far that was checked; None of a pair of one's own.

    A pair is the catalogue's where it has every number of the one that has its designation.
    """
    try:
        if pair_by_designation(pair.designation) != pair:
            return None
    except InvalidValueError:
        return None
    if pair.designation == _DESIGNATION[RootForm.NEWER]:
        return f"{standard_source(DEFAULT_DESIGNATION)}; the bolt's minor diameter from newer editions"
    return standard_source(pair.designation)


def is_known(designation: str) -> bool:
    """Whether a pair of the catalogue has this very designation, as this project writes it."""
    try:
        return pair_by_designation(designation).designation == designation
    except InvalidValueError:
        return False
