"""What a file may say of a pair; which dimensions are possible is for the domain to say."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from threadstate.units import LengthUnit

LARGEST_DESIGNATION = 100

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=LARGEST_DESIGNATION)]


class Part(BaseModel):
    """A table of the file, which may hold the keys below and no others."""

    model_config = ConfigDict(extra="forbid")

    def given(self) -> dict[str, Any]:
        """The values that the file gives."""
        return {name: getattr(self, name) for name in self.model_fields_set}


class FormPart(Part):
    """A thread form; fillets in multiples of the thread pitch."""

    name: Name | None = None
    flank_half_angle_deg: Number | None = None
    bolt_root_fillet: Number | None = None
    bolt_crest_fillet: Number | None = None
    nut_root_fillet: Number | None = None
    nut_crest_fillet: Number | None = None


class FitPart(Part):
    """A fit, in the pair's unit."""

    name: Name | None = None
    bolt_major_diameter: Number | None = None
    bolt_pitch_diameter: Number | None = None
    bolt_minor_diameter: Number | None = None
    nut_major_diameter: Number | None = None
    nut_pitch_diameter: Number | None = None
    nut_minor_diameter: Number | None = None


class PairPart(Part):
    """A pair: a known one by its designation, or one's own by its dimensions, which ``like`` may give in part."""

    designation: Name
    like: str | None = None
    unit: LengthUnit | None = None
    nominal_diameter: Number | None = None
    thread_pitch: Number | None = None
    form: FormPart | None = None
    fit: FitPart | None = None
    fits: Annotated[list[FitPart], Field(min_length=1)] | None = None


class PairsPart(Part):
    """The pairs of a file that lists them."""

    pair: list[PairPart]


TABLES: dict[str, type[Part]] = {"pair": PairPart, "form": FormPart, "fit": FitPart, "fits": FitPart}
"""The tables by the key that they stand under."""
