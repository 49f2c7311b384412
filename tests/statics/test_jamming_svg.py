"""The picture of a jamming diagram."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.statics.test_jamming import MU, PAIR, RIM_LEFT, TIP_RIGHT, UP, Contact, diagram, states
from threadstate.state.solve import solve_poses
from threadstate.statics.jamming import JammingDiagram, jamming_diagram
from threadstate.statics.jamming_document import jamming_document, piece_text
from threadstate.statics.jamming_svg import jamming_svg

pytestmark = pytest.mark.slow

SVG = "{http://www.w3.org/2000/svg}"


def picture(found: JammingDiagram) -> ElementTree.Element:
    text = jamming_svg(jamming_document(states()[0], found))
    assert "nan" not in text
    assert "inf" not in text.replace("inside", "")
    return ElementTree.fromstring(text)


def texts(root: ElementTree.Element) -> list[str]:
    return [element.text or "" for element in root.iter(f"{SVG}text")]


def test_every_piece_is_drawn_with_a_letter_and_described() -> None:
    found = jamming_diagram(PAIR, states()[0], 1.0)
    document = jamming_document(states()[0], found)
    root = picture(found)
    assert root.find(f"{SVG}title") is not None
    shown = texts(root)
    assert {"Fx / Fz", "My / (r Fz)", "push"} <= set(shown)
    letters = [text for text in shown if re.fullmatch("[a-z]", text)]
    named = letters[: len(letters) // 2]
    assert letters == named * 2
    assert len(named) >= 4
    assert (len(named) < len(found.pieces)) == ("and a shorter piece" in shown)
    described = [piece for piece in document["pieces"] if piece_text(document, piece) in shown]
    assert len(described) == len(named)
    for piece in described:
        sliding = [one for one in piece["contacts"] if one["mode"] == "slides"]
        assert all(
            f"contact {one['contact']} slides, friction {one['side']}" in piece_text(document, piece) for one in sliding
        )
    strokes = [path for path in root.iter(f"{SVG}path") if path.get("class") == "edge"]
    assert len(strokes) == sum(
        sum(one["mode"] == "slides" for one in piece["contacts"]) or len(piece["contacts"])
        for piece in document["pieces"]
    )
    # The inside is the vertices' polygon, as far as two decimals of a pixel tell.
    (inside,) = (path for path in root.iter(f"{SVG}path") if path.get("class") == "inside")
    places = np.array(
        [[float(x) for x in pair.split()] for pair in re.split("[ML]", (inside.get("d") or "").strip("Z"))[1:]]
    )
    low, high = found.vertices.min(axis=0), found.vertices.max(axis=0)
    aspect = np.ptp(places, axis=0) / (high - low)
    corner = found.vertices[found.pieces[0].first]
    left, top = places.min(axis=0)
    expected = [left + (corner[0] - low[0]) * aspect[0], top + (high[1] - corner[1]) * aspect[1]]
    assert np.hypot(*(places - expected).T).min() < 0.5


@pytest.mark.parametrize(
    ("contacts", "mu", "axes", "message"),
    [
        ([((0.5, 0.2, 0.0), UP)], MU, ("fx", "my"), "The contacts balance no load of this plane."),
        ([((0.0, 0.0, 0.0), UP)], 0.0, ("mx", "my"), "The contacts balance one load of this plane alone."),
        ([((0.5, 0.0, 0.0), UP)], MU, ("fx", "my"), "The contacts balance the loads on a segment."),
        (
            [TIP_RIGHT, RIM_LEFT],
            0.6,
            ("fx", "my"),
            "Contacts 1, 2 can wedge: they press against each other without any load.",
        ),
    ],
)
def test_degenerate_diagrams_say_what_they_are(
    contacts: list[Contact], mu: float, axes: tuple[str, str], message: str
) -> None:
    assert message in texts(picture(diagram(contacts, mu, *axes)))


def test_a_window_is_no_edge() -> None:
    found = diagram([TIP_RIGHT, RIM_LEFT], MU)
    root = picture(found)
    drawn = sum(path.get("class") == "edge" for path in root.iter(f"{SVG}path"))
    # Two contacts slide on one piece; on those beside it one sticks.
    assert drawn == 4
    assert len(found.pieces) > 3


def test_the_picture_of_the_docs_is_what_the_command_draws(repository_root: Path) -> None:
    (state,) = solve_poses(PAIR, [(3, 2, 320)])
    drawn = jamming_svg(jamming_document(state, jamming_diagram(PAIR, state, 0.4)))
    stored = (repository_root / "docs" / "jamming.svg").read_text()
    assert texts(ElementTree.fromstring(stored)) == texts(ElementTree.fromstring(drawn))
    assert stored.split("</style>")[0] == drawn.split("</style>")[0]
