"""Other geometries that the paper's words allow: it gives neither fit nor fillet radii."""

from __future__ import annotations

from dataclasses import replace

from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.fit import Fit
from threadstate.thread.pair import Pair

LOOSEST = Fit(
    name="2A/2B, least material",
    bolt_major_diameter=0.2408,
    bolt_pitch_diameter=0.2127,
    bolt_minor_diameter=0.1857,
    nut_major_diameter=0.2500,
    nut_pitch_diameter=0.2223,
    nut_minor_diameter=0.2070,
)
"""The other end of the tolerances of 1/4-20 UNC, in inches.

The bolt's minor diameter is as far below its pitch diameter as in the declared fit.
"""

ROUNDED_ROOT = 0.144
"""Fillet of a bolt's root that is one arc from flank to flank, nearly, in thread pitches."""


def other_geometries() -> dict[str, Pair]:
    """The pairs by what is different in them, to be read after "if"."""
    pair = quarter_twenty_unc()
    form = pair.form
    halved = replace(
        form,
        bolt_root_fillet=form.bolt_root_fillet / 2.0,
        bolt_crest_fillet=form.bolt_crest_fillet / 2.0,
        nut_root_fillet=form.nut_root_fillet / 2.0,
        nut_crest_fillet=form.nut_crest_fillet / 2.0,
    )
    return {
        "the fit is in the middle of its tolerances": replace(pair, fit=_between(pair.fit, LOOSEST)),
        "the fit is at its loosest": replace(pair, fit=LOOSEST),
        "all fillets are half as large": replace(pair, form=halved),
        "the bolt's root is rounded throughout": replace(pair, form=replace(form, bolt_root_fillet=ROUNDED_ROOT)),
    }


def _between(tight: Fit, loose: Fit) -> Fit:
    return Fit(
        name="2A/2B, middle",
        bolt_major_diameter=(tight.bolt_major_diameter + loose.bolt_major_diameter) / 2.0,
        bolt_pitch_diameter=(tight.bolt_pitch_diameter + loose.bolt_pitch_diameter) / 2.0,
        bolt_minor_diameter=(tight.bolt_minor_diameter + loose.bolt_minor_diameter) / 2.0,
        nut_major_diameter=(tight.nut_major_diameter + loose.nut_major_diameter) / 2.0,
        nut_pitch_diameter=(tight.nut_pitch_diameter + loose.nut_pitch_diameter) / 2.0,
        nut_minor_diameter=(tight.nut_minor_diameter + loose.nut_minor_diameter) / 2.0,
    )
