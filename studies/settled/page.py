"""The page of settled states beside the paper's: its tables and its words."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence

import numpy as np

from studies.settled.study import PAPER_KINDS, SAME_AXIS_DEG, SAME_POINT, SETTLED_KINDS, ComparedPose
from threadstate.device.model import Device
from threadstate.numbers import number_text
from threadstate.state.model import StateClass
from threadstate.thread.pair import Pair


def page(
    pair: Pair,
    device: Device,
    poses: Sequence[ComparedPose],
    by_tilt: Sequence[tuple[Device, Sequence[ComparedPose]]],
) -> str:
    """The page in Markdown; ``by_tilt`` has fewer poses of devices that differ in their stiffness against tilts."""
    parts = (
        _kinds(device, poses),
        _poses(poses),
        _turns(poses),
        _softer(by_tilt),
        _embedded(pair, poses),
        _contacts(pair, poses),
    )
    return "\n".join(line for part in parts for line in part) + "\n"


def _row(*cells: object) -> str:
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def _share(part: int, whole: int) -> str:
    return f"{part:,} ({100.0 * part / whole:.0f} %)" if whole else "0"


def _named(kind: str) -> str:
    return kind.replace("_", " ")


def _of(poses: Sequence[ComparedPose], kind: str) -> list[ComparedPose]:
    return [one for one in poses if one.paper_kind == kind]


def _kinds(device: Device, poses: Sequence[ComparedPose]) -> list[str]:
    lines = [
        "# Where a held bolt rests, beside the paper's states",
        "",
        *_paragraph(
            "`make settled` writes this page for 1/4-20 UNC: the contact states of the default library"
            f" ([method](method.md)) beside the settled states of [the device](device.md) by default, {len(poses):,}"
            " poses. The paper turns the bolt about a tangent and an axis until something touches, and admits"
            " embedment; a settled state is where a bolt comes to rest, without friction and without any overlap. The"
            f" device gives way by {_tilt(device)} against tilts and {number_text(device.stiffness[3][3])} N a"
            f" {device.unit} sideways, and pushes with {number_text(device.push)} N. Another device gives other"
            " figures; the paper's procedure knows none."
        ),
        "",
        "## What the paper's classes come to rest on",
        "",
        _row("paper's class", "poses", *map(_rests, SETTLED_KINDS), "agree"),
        _row(*["---"] * (len(SETTLED_KINDS) + 3)),
    ]
    for kind in PAPER_KINDS:
        of_kind = _of(poses, kind)
        rests = Counter(one.settled_kind for one in of_kind)
        cells = (_share(rests[name], len(of_kind)) for name in SETTLED_KINDS)
        agree = sum(one.agrees for one in of_kind)
        lines.append(_row(_named(kind), f"{len(of_kind):,}", *cells, _share(agree, len(of_kind))))
    agree = sum(one.agrees for one in poses)
    fell = sum(bool(one.settled.falls) for one in poses)
    flags = Counter(flag for one in poses if one.settled_kind == "not settled" for flag in one.settled.flags)
    reasons = ", ".join(f"`{flag}` {count:,}" for flag, count in sorted(flags.items())) or "none"
    return [
        *lines,
        "",
        *_paragraph(
            "A pose *agrees* where the bolt rests flush as the paper has it, or on as many contacts as its class has,"
            f" and its axis is within {SAME_AXIS_DEG:g} deg of the paper's last pose: {_share(agree, len(poses))} of"
            f" all. On the way {fell:,} bolts fall, which no turn of the paper's does. Not settled, by flag: {reasons}."
        ),
        "",
        "![What a bolt rests on](settled/rest.svg)",
        "",
    ]


def _rests(kind: str) -> str:
    return {"flush": "rest flush", "not settled": "have no certain answer"}.get(kind, f"rest on {kind}")


def _paragraph(text: str) -> list[str]:
    return textwrap.wrap(text, 118, break_long_words=False, break_on_hyphens=False)


def _poses(poses: Sequence[ComparedPose]) -> list[str]:
    lines = [
        "## How far from the paper's last pose it rests",
        "",
        "The angle between the bolt's axes, in degrees:",
        "",
        _row("paper's class", "poses", "least", "median", "nine of ten below", "most", f"below {SAME_AXIS_DEG:g} deg"),
        _row(*["---"] * 7),
    ]
    for kind in PAPER_KINDS:
        apart = [one.apart_deg for one in _of(poses, kind) if one.apart_deg is not None]
        if apart:
            shown = (min(apart), float(np.median(apart)), float(np.quantile(apart, 0.9)), max(apart))
            near = sum(angle < SAME_AXIS_DEG for angle in apart)
            sizes = (f"{value:.3f}" for value in shown)
            lines.append(_row(_named(kind), f"{len(apart):,}", *sizes, _share(near, len(apart))))
    return [*lines, "", "![Angle to the paper's last pose](settled/apart.svg)", ""]


def _turns(poses: Sequence[ComparedPose]) -> list[str]:
    lines = [
        "## Turns that lead away",
        "",
        *_paragraph(
            "A turn leads away where the bolt's axis is farther, after it, from where it rests than before it. Most"
            " second turns lead nearer. The third turn goes about the axis through two contacts, in the sense that"
            " lowers the bolt's origin: what the device resists stops a held bolt long before."
        ),
        "",
        _row("paper's class", "second turns", "lead away", "third turns", "lead away"),
        _row(*["---"] * 5),
    ]
    for kind in PAPER_KINDS:
        second, third = (
            [away for one in _of(poses, kind) if (away := one.turns_away(stage)) is not None] for stage in (2, 3)
        )
        cells = (
            f"{len(second):,}",
            _share(sum(second), len(second)),
            f"{len(third):,}",
            _share(sum(third), len(third)),
        )
        lines.append(_row(_named(kind), *cells))
    return [*lines, ""]


def _softer(by_tilt: Sequence[tuple[Device, Sequence[ComparedPose]]]) -> list[str]:
    lines = [
        "## A softer device",
        "",
        "What the stiffness against tilts does to this, at fewer phases: the paper's turns stand for a device that",
        "gives way without end.",
        "",
        _row(
            "against tilts",
            "poses",
            "agree",
            "second turns that lead away",
            "third turns of stable states",
            "not certain",
        ),
        _row(*["---"] * 6),
    ]
    for device, poses in by_tilt:
        second = [away for one in poses if (away := one.turns_away(2)) is not None]
        stable = _of(poses, StateClass.STABLE_THREE_POINT.value)
        third = [away for one in stable if (away := one.turns_away(3)) is not None]
        cells = (
            _share(sum(one.agrees for one in poses), len(poses)),
            _share(sum(second), len(second)),
            _share(sum(third), len(third)),
            _share(sum(one.settled_kind == "not settled" for one in poses), len(poses)),
        )
        lines.append(_row(_tilt(device), f"{len(poses):,}", *cells))
    return [*lines, ""]


def _tilt(device: Device) -> str:
    return f"{number_text(device.stiffness[0][0])} N {device.unit} a rad"


def _embedded(pair: Pair, poses: Sequence[ComparedPose]) -> list[str]:
    embedded = [one for one in poses if one.embeds]
    known = [one for one in embedded if one.lift is not None]
    lifts = [100.0 * one.lift / pair.thread_pitch for one in known if one.lift is not None]
    depths = [100.0 * one.state.embedment / pair.thread_pitch for one in known if one.state.embedment is not None]
    rests = Counter(one.settled_kind for one in embedded)
    shown = ", ".join(f"{rests[kind]:,} {_rests(kind)}" for kind in SETTLED_KINDS if rests[kind])
    lower = sum(lift < 0.0 for lift in lifts)
    return [
        "## Where the paper embeds",
        "",
        *_paragraph(
            f"In {len(embedded):,} of the paper's last poses the solids overlap, which no bolt does. Of these bolts"
            f" {shown}. Lengths in hundredths of the thread pitch:"
        ),
        "",
        _row("", "median", "nine of ten below", "most"),
        _row(*["---"] * 4),
        _row("embedment of the paper's last pose", *_quantiles(depths)),
        _row("height at rest above the paper's last pose", *_quantiles(lifts)),
        "",
        f"{lower:,} of these bolts rest lower than the paper's last pose, at another tilt.",
        "",
    ]


def _quantiles(values: Sequence[float]) -> list[str]:
    return [f"{value:.2f}" for value in (np.median(values), np.quantile(values, 0.9), np.max(values))]


def _contacts(pair: Pair, poses: Sequence[ComparedPose]) -> list[str]:
    lines = [
        "## Whether the contacts are the same",
        "",
        "Of poses that rest on contacts: how many of these have the features of one of the paper's contacts and are",
        f"within {SAME_POINT:g} nominal radii of it.",
        "",
        _row("paper's class", "rest on contacts", "all the same", "some", "none"),
        _row(*["---"] * 5),
    ]
    for name in reversed(StateClass):
        resting = [one for one in _of(poses, name.value) if one.settled.contacts and one.settled_kind != "flush"]
        shared = [(one.shared_contacts(pair.nominal_diameter / 2.0), len(one.settled.contacts)) for one in resting]
        every = sum(same == count for same, count in shared)
        none = sum(same == 0 for same, _ in shared)
        counts = (every, len(shared) - every - none, none)
        lines.append(_row(_named(name.value), f"{len(shared):,}", *(_share(count, len(shared)) for count in counts)))
    return lines
