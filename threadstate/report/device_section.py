"""The device and the pair of a report, in both units of length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from threadstate.device.document import device_document
from threadstate.device.model import About, Device
from threadstate.report import repeat
from threadstate.report.contents import Report
from threadstate.report.html import paragraph, table
from threadstate.report.words import NEWTON, exact, rounded
from threadstate.thread.pair import Pair
from threadstate.thread.play import play_of
from threadstate.units import LengthUnit

STIFFNESSES = {
    "k_lateral": ("lateral stiffness", "N/{unit}"),
    "k_axial": ("axial stiffness", "N/{unit}"),
    "k_tilt": ("tilt stiffness", NEWTON + "{unit}/rad"),
    "k_twist": ("twist stiffness", NEWTON + "{unit}/rad"),
}
UNITS = {LengthUnit.INCH: "in inches", LengthUnit.MILLIMETRE: "in millimetres"}
ABOUT = {
    About.NUT: "The hand turns about the nut's axis: the tilt goes round with the phase.",
    About.BOLT: "The hand turns about its own axis: the tilt stays in space.",
}


def device_section(report: Report) -> Iterator[str]:
    """Stiffnesses, centre and push, then the pair with its diameters."""
    device, pair = report.inputs.device, report.inputs.pair
    if repeat.is_default(device):
        yield paragraph("This is the default device of threadstate: declared, not measured.")
    yield from _device(device)
    yield paragraph(
        f"{ABOUT[device.about]} The compliance centre lies on the bolt's axis at that height over its base; below "
        "zero it is projected beyond the tip."
    )
    units = _units(pair.unit)
    yield table(
        f"The pair: {pair.designation}",
        ("dimension", *(UNITS[unit] for unit in units)),
        _dimensions([pair.in_unit(unit) for unit in units]),
        words={0},
    )
    yield paragraph(_form(pair))


def _units(own: LengthUnit) -> tuple[LengthUnit, LengthUnit]:
    """A unit, and the other one."""
    return own, LengthUnit.INCH if own is LengthUnit.MILLIMETRE else LengthUnit.MILLIMETRE


def _device(device: Device) -> Iterator[str]:
    units = _units(device.unit)
    documents = [device_document(device.in_unit(unit)) for unit in units]
    rows = []
    for key, (name, unit_of) in STIFFNESSES.items():
        if key in documents[0]:
            values = [_stiffness(document[key], unit_of, unit) for document, unit in zip(documents, units, strict=True)]
            rows.append((f"{name} ({key})", *values))
    centres = [f"{rounded(document['centre'])} {unit}" for document, unit in zip(documents, units, strict=True)]
    rows.append(("height of the compliance centre", *centres))
    rows.append(("push", *[f"{rounded(device.push)} N"] * 2))
    yield table("The device", ("quantity", *(UNITS[unit] for unit in units)), rows, words={0})
    for document, unit in zip(documents, units, strict=True):
        if "stiffness" in document:
            yield table(
                f"Stiffness in N, {unit} and rad: turns about x, y, z, then shifts along x, y, z",
                ("", "turn x", "turn y", "turn z", "shift x", "shift y", "shift z"),
                [
                    (name, *map(rounded, row))
                    for name, row in zip(
                        ("turn x", "turn y", "turn z", "shift x", "shift y", "shift z"),
                        document["stiffness"],
                        strict=True,
                    )
                ],
                words={0},
            )


def _stiffness(value: float | str, unit_of: str, unit: LengthUnit) -> str:
    return value if isinstance(value, str) else f"{rounded(value)} {unit_of.format(unit=unit)}"


def _dimensions(pairs: Sequence[Pair]) -> list[tuple[str, ...]]:
    """The lengths of a pair, in each unit."""

    def row(name: str, lengths: Sequence[float | None]) -> tuple[str, ...]:
        return (name, *(rounded(length, 6) for length in lengths))

    plays = [play_of(pair) for pair in pairs]
    rows = [
        row("nominal diameter", [pair.nominal_diameter for pair in pairs]),
        row("thread pitch", [pair.thread_pitch for pair in pairs]),
        row("lead", [pair.lead for pair in pairs]),
    ]
    for part in ("bolt", "nut"):
        for which in ("major", "pitch", "minor"):
            lengths = [getattr(pair.fit, f"{part}_{which}_diameter") for pair in pairs]
            rows.append(row(f"{which} diameter of the {part}", lengths))
    rows.append(row("axial play, either way", [play.axial for play in plays]))
    rows.append(row("radial play at the bolt's crest", [play.crest for play in plays]))
    rows.append(row("radial play at the bolt's root", [play.root for play in plays]))
    return rows


def _form(pair: Pair) -> str:
    form = pair.form
    second = form.flank_half_angle_neg_deg
    flanks = f"{exact(form.flank_half_angle_deg)}°" + ("" if second is None else f" and {exact(second)}°")
    fillets = [
        f"{name} {rounded(ratio)}"
        for name, ratio in (
            ("bolt root", form.bolt_root_fillet),
            ("bolt crest", form.bolt_crest_fillet),
            ("nut root", form.nut_root_fillet),
            ("nut crest", form.nut_crest_fillet),
        )
    ]
    starts = "one start" if pair.starts == 1 else f"{pair.starts} starts"
    return (
        f"Form {form.name}, fit {pair.fit.name}, {pair.hand.value}-hand, {starts}; flanks at {flanks} to the normal "
        f"of the axis; fillets in thread pitches: {', '.join(fillets)}. The diameters are those that were computed "
        "with, not a range."
    )
