"""``threadstate profiles``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from threadstate import settings
from threadstate.errors import InvalidValueError
from worker.options import Dimensions, Json, UnitName
from worker.output import print_json

if TYPE_CHECKING:
    from threadstate.thread.pair import Pair
    from threadstate.thread.profile import Profile


def profiles(
    pairs: Annotated[
        list[str] | None,
        typer.Option(
            "--pair",
            metavar="NAME",
            help="A pair as for other commands; any number of times.",
            show_default=f"{settings.PAIR}, else 1/4-20 UNC",
        ),
    ] = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", metavar="FILE", help="Draw an axial section of each, too, as .svg."),
    ] = None,
    as_json: Json = False,
) -> None:
    r"""Print the diameters and fillets of pairs, and the play between bolt and nut.

    The axes coincide and the bolt is midway in its axial play. Pairs are drawn below each other in the same scale of
    thread pitches.

    \b
    Examples:
      threadstate profiles --pair M6
      threadstate profiles --pair "1/4-20 UNC-3A/3B" --pair "M6 at minimum material" --plot profiles.svg
      threadstate profiles --pair examples/m6x1.toml --unit in --json
    """
    from worker.plots import check_plot_file

    if plot is not None:
        check_plot_file(plot, (".svg",))
    if dimension and pairs is not None and len(pairs) > 1:
        raise InvalidValueError("--dimension", ", ".join(dimension), "with one --pair")

    from threadstate.thread.catalogue import source_of
    from threadstate.thread.play import play_of
    from threadstate.thread.profiles_svg import profiles_svg
    from threadstate.units import conversion_factor, scale_length
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_profiles

    chosen = [chosen_pair(name, dimension or ()) for name in pairs or (None,)]
    if plot is not None:
        plot.write_text(profiles_svg(chosen, unit))
    if not as_json:
        print_profiles(chosen, unit)
        return
    entries = []
    for one in chosen:
        shown, play = unit or one.unit, play_of(one)
        factor = conversion_factor(one.unit, shown)
        entries.append(
            {
                "designation": one.designation,
                "source": source_of(one),
                "unit": shown.value,
                "thread_pitch": one.thread_pitch * factor,
                "starts": one.starts,
                "hand": one.hand.value,
                "bolt": _profile(one.bolt, factor),
                "nut": _profile(one.nut, factor),
                **_chamfer(one, factor),
                "play": {
                    "crest": play.crest * factor,
                    "root": play.root * factor,
                    "axial": scale_length(play.axial, factor),
                },
            }
        )
    print_json({"profiles": entries})


def _chamfer(pair: Pair, factor: float) -> dict[str, dict[str, float]]:
    """The chamfer of a pair's bolt, where it has one."""
    if pair.chamfer is None:
        return {}
    return {"chamfer": {"end_diameter": pair.chamfer.end_diameter * factor, "angle_deg": pair.chamfer.angle_deg}}


def _profile(profile: Profile, factor: float) -> dict[str, float]:
    lengths = ("major_diameter", "pitch_diameter", "minor_diameter", "major_fillet_radius", "minor_fillet_radius")
    return {name: getattr(profile, name) * factor for name in lengths}
