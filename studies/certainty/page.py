"""docs/certainty.md and its picture."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure

from studies.certainty.study import AGREEMENT, DEFAULT, Compared
from studies.pictures import FAINT, picture

Results = Mapping[str, Mapping[str, Compared]]
MOST_LISTED = 12


def relative_times(results: Results) -> dict[str, float]:
    """Processor time of each setting over that of the one in use for the same poses, of all pairs together."""
    return {
        name: sum(one.seconds for one in by_pair.values()) / sum(one.seconds_in_use for one in by_pair.values())
        for name, by_pair in results.items()
    }


def late_counts(results: Results) -> dict[str, int]:
    """Of each setting, over all pairs, the poses of which it finds a contact late."""
    return {name: sum(len(one.late) for one in by_pair.values()) for name, by_pair in results.items()}


def page(results: Results) -> str:
    """The page, for the results of all settings."""
    times, late = relative_times(results), late_counts(results)
    in_use = results[DEFAULT.name]
    poses = sum(one.poses for one in in_use.values())
    lines = [
        "# What certainty costs where thread meets thread",
        "",
        "![Poses of which a contact is found late against the time a pose, one mark a setting.](certainty.svg)",
        "",
        "That nothing of the edges comes earlier than a contact is [proved](certificate.md). Contacts of thread with",
        "thread are *searched*: at instants of a motion the ridges of the bolt's thread are looked for between",
        "azimuths, and their maxima are followed to where they touch. More azimuths and more instants miss",
        "less and take longer; rectangles of the bolt's thread can be closed by bounds in place of that.",
        "`make certainty` wrote this page.",
        "",
        f"{poses:,} random poses, half of them near in phase, tilted by up to 4 deg in roll and pitch. A contact that",
        "is found is there, as it is refined on the surfaces; so of two settings that differ by more than",
        f"{AGREEMENT:.0e} (thread pitches, radians) the one with the earlier contact is right, and the other's is",
        "*late*. Where all settings are late nothing shows. Times are processor time of one core, over that of the",
        "setting in use, and hold for this sample.",
        "",
        "| setting | poses | time | late | refused |",
        "|---|---|---|---|---|",
    ]
    for name, by_pair in results.items():
        refused = sum(one.refused for one in by_pair.values())
        asked = sum(one.poses for one in by_pair.values())
        lines.append(f"| {name} | {asked:,} | {times[name]:.3g} | {late[name]} | {refused} |")
    lines += ["", "## By pair", "", "Late of how many poses:", ""]
    lines += ["| setting | " + " | ".join(in_use) + " |", "|---|" + "---|" * len(in_use)]
    for name, by_pair in results.items():
        lines.append(
            f"| {name} | " + " | ".join(f"{len(one.late)} of {one.poses:,}" for one in by_pair.values()) + " |"
        )
    lines += ["", "## Late with the setting in use", ""]
    listed = [(pair, place) for pair, one in in_use.items() for place in one.late]
    if listed:
        lines += ["| pair | roll, pitch, phase (deg) |", "|---|---|"]
        lines += [f"| {pair} | {a!r}, {b!r}, {c!r} |" for pair, (a, b, c) in listed[:MOST_LISTED]]
        if len(listed) > MOST_LISTED:
            lines += ["", f"And {len(listed) - MOST_LISTED} more."]
    else:
        lines.append("None.")
    return "\n".join(
        [*lines, "", "[Decision 35](decisions/0035-certainty.md) says which setting is in use, and why.", ""]
    )


def chart(results: Results) -> str:
    """The picture, as SVG: share of late poses against relative time, both logarithmic; none is at the bottom."""
    times, late = relative_times(results), late_counts(results)
    poses = {name: sum(one.poses for one in by_pair.values()) for name, by_pair in results.items()}
    none = 0.3 / max(poses.values())

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        for name in results:
            share = late[name] / poses[name]
            axes.plot(times[name], share or none, "o" if name != DEFAULT.name else "D", label=name)
        axes.axhline(none, color=FAINT, linewidth=0.8, linestyle=":")
        axes.annotate("none", (1.0, none), color=FAINT, va="bottom", xycoords=("axes fraction", "data"), ha="right")
        axes.set(
            xscale="log",
            yscale="log",
            xlabel="time a pose, over that of the setting in use",
            ylabel="share of poses with a late contact",
        )
        figure.legend(loc="outside right upper")

    return picture((9.0, 4.2), "What certainty costs", draw)
