"""The explorer's tab of the load: what it does to the state, its diagram, the map of frictions."""

from __future__ import annotations

import pytest

from harness.browser import Explorer
from tests.explorer.test_explorer import MINUS, settled_canvas

pytestmark = pytest.mark.slow

STATICS = "/v1/libraries/latest/states/-4/-4/200/statics"
JAMMING = "/v1/libraries/latest/states/-4/-4/200/jamming"


def shown(value: float | None) -> str:
    return "none" if value is None else f"{value:.4f}".replace("-", MINUS)


def outline(explorer: Explorer) -> str:
    """The corners of the diagram that is drawn."""
    corners = "return document.querySelector('#jamming .inside')?.getAttribute('points') ?? ''"
    return str(explorer.run(corners))


def test_sliders_show_what_the_service_says_of_the_load(explorer: Explorer) -> None:
    explorer.open("/#roll=-4&pitch=-4&phase=200&tab=load")
    found = explorer.fetched(f"{STATICS}?mu=0.2")
    explorer.wait_for_text("#load-numbers", shown(found["support_margin"]))
    explorer.choose("#slider-mu", "0.5")
    explorer.choose("#slider-my", "-0.4")
    explorer.choose("#load-push", "10")
    loaded = explorer.fetched(f"{STATICS}?mu=0.5&force=0,0,-10&moment=0,-0.5,0")
    explorer.wait_for_text("#load-numbers", shown(loaded["support_margin"]))
    explorer.wait_for_text("#load-numbers", shown(loaded["mu_wedge"]))
    assert loaded["support_margin"] != found["support_margin"]
    explorer.wait(lambda: "mu=0.5" in explorer.run("return location.hash"), "the address has no friction")
    for name, value in (("mu", "-1"), ("push", "0"), ("fx", "1000")):
        explorer.choose(f"#load-{name}", value)
        explorer.wait_for_text("#toast", f"is {value}; valid:")


def test_the_diagram_is_drawn_and_follows_friction_and_plane(explorer: Explorer) -> None:
    explorer.open("/#roll=-4&pitch=-4&phase=200&tab=load&mu=0.8")
    explorer.one("#jamming .edge")
    explorer.wait(lambda: len(outline(explorer)) > 0, "no outline")
    first = outline(explorer)
    pieces = explorer.fetched(f"{JAMMING}?mu=0.8&tolerance=0.002")["pieces"]
    explorer.wait(lambda: len(explorer.all("#jamming .edge")) == len(pieces), "not all pieces of the outline")
    explorer.choose("#slider-mu", "1")
    explorer.wait(lambda: outline(explorer) not in ("", first), "the outline stays")
    explorer.choose("#plane", "mx,my")
    explorer.wait_for_text("#jamming", "Mx / (push r)")
    explorer.choose("#phase", "200.25")
    explorer.wait_for_text("#state", "the exact solver, computed now")
    explorer.wait_for_text("#jamming", "Mx / (push r)")


def test_forces_are_seen_beside_the_solids_in_this_tab_alone(explorer: Explorer) -> None:
    explorer.open("/#roll=0&pitch=-4&phase=180&nut=off&tab=load&my=0.6")
    explorer.wait(lambda: not explorer.run("return document.querySelector('#force-legend').hidden"), "no forces")
    loaded = settled_canvas(explorer)
    explorer.click("#tab-state")
    explorer.wait(lambda: bool(explorer.run("return document.querySelector('#force-legend').hidden")), "forces stay")
    assert settled_canvas(explorer) != loaded


def test_the_map_shows_the_friction_that_holds(explorer: Explorer) -> None:
    explorer.choose("#quantity", "mu_hold")
    (state,) = explorer.fetched("/v1/libraries/latest/states?roll=0&pitch=-4&phase=10")["states"]
    value = state["statics"]["mu_hold"]
    explorer.wait_for_text(
        "#map-readout", f"\N{GREEK SMALL LETTER MU} that holds {'none' if value is None else f'{value:.3f}'}"
    )
    explorer.choose("#over", "all")
    entries = explorer.fetched("/v1/libraries/latest/orientations")["orientations"]
    (entry,) = [one for one in entries if (one["roll"], one["pitch"]) == (0, -4)]
    explorer.wait_for_text("#map-readout", f"least friction that holds a push {entry['mu_hold_least']:.3f}")
