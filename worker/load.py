"""The options of a load, and the load that they say."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.numbers import three_numbers
from threadstate.statics.load import Load
from worker.options import number_option

Force = Annotated[str, typer.Option("--force", metavar="X,Y,Z", help="Force on the bolt in N, in the nut's frame.")]
Moment = Annotated[str, typer.Option("--moment", metavar="X,Y,Z", help="Moment on the bolt, in N times the unit.")]
Point = Annotated[
    str | None,
    typer.Option(
        "--point",
        metavar="X,Y,Z",
        help="The point about which the moment is taken.",
        show_default="the bolt's origin",
    ),
]
UnderMu = Annotated[
    float | None,
    number_option("--mu", metavar="M", help="Under a load, at this coefficient of friction of all contacts."),
]
Avoid = Annotated[
    str,
    typer.Option(
        "--avoid",
        metavar="MARKS",
        help="Under a load: no move leaves what is so marked, with commas: free, held, wedged, undecided.",
    ),
]

PUSH = "0,0,-1"
NO_MOMENT = "0,0,0"
WEDGED = "wedged"


def needs_friction(mu: float | None, force: str, moment: str, point: str | None, avoid: str = WEDGED) -> None:
    """Check that nothing of a load is given without a friction.

    Raises:
        InvalidValueError: something is.
    """
    given = {
        "--force": (force, PUSH),
        "--moment": (moment, NO_MOMENT),
        "--point": (point, None),
        "--avoid": (avoid, WEDGED),
    }
    for name, (value, default) in given.items():
        if mu is None and value != default:
            raise InvalidValueError(name, value, "with --mu, the coefficient of friction under that load")


def chosen_load(force: str, moment: str, point: str | None, factor: float) -> Load:
    """The load of the options, whose lengths are ``factor`` times the pair's.

    Raises:
        InvalidValueError: a text is not three numbers, or the load is zero.
    """
    return Load(
        force=three_numbers("--force", force),
        moment=three_numbers("--moment", moment),
        point=None if point is None else three_numbers("--point", point),
    ).with_lengths_over(factor)
