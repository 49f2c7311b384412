"""The explorer's tab of the device: the path of a held bolt, played on the solids above its curves."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver.common.keys import Keys

from harness.browser import Explorer
from tests.explorer.test_explorer import MINUS, settled_canvas
from tests.service.test_assemblies import computing
from threadstate.device.document import LIMITS, device_document
from threadstate.device.model import SettledFlag, default_device
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow

ENGAGING = "roll=1&pitch=-2&phase=10&nut=off&tab=device"
COMPUTED = f"{ENGAGING}&assembly=roll%3D1%26pitch%3D-2%26phase%3D10%26strategy%3Dcw%26unit%3Din"
LONG_AT, LONG = "roll=-2&pitch=-1&phase=0&nut=off&tab=device", {"strategy": "ccw_then_cw", "mu": "0.2"}
"""A path of many seconds on any machine: where it starts, and the fields of its device."""


def value_of(explorer: Explorer, selector: str) -> str:
    return str(explorer.run("return document.querySelector(arguments[0]).value", selector))


def choose_device(explorer: Explorer, **values: str) -> None:
    for name, value in values.items():
        explorer.choose(f"#device-{name}", value)


def computed(explorer: Explorer, body: dict[str, Any]) -> Any:
    """The path that the service answers to the page's own fetch."""
    return explorer.chromium.execute_async_script(
        "const [body, done] = arguments; const headers = {'Content-Type': 'application/json'};"
        "fetch('/v1/assemblies', {method: 'POST', headers, body: JSON.stringify(body)})"
        ".then((answer) => answer.json()).then(done)",
        body,
    )


def test_a_path_is_computed_and_what_is_shown_is_the_answer(explorer: Explorer) -> None:
    explorer.open(f"/#{ENGAGING}")
    explorer.one("#device-fields input")
    assert [value_of(explorer, f"#device-{name}") for name in ("roll", "pitch", "phase")] == ["1", "-2", "10"]
    choose_device(explorer, strategy="cw", push="8", confirm="yes")
    explorer.click("#device-compute")
    explorer.wait_for_text("#turned-outcome", "The bolt engages. Margin of the height on the lead:")
    body = {"pose": {"roll": 1, "pitch": -2, "phase": 10}, "strategy": "cw", "device": {"unit": "in", "push": 8}}
    answer = computed(explorer, {**body, "library": 1, "confirm": True})
    count = len(answer["path"]["phase"])
    assert explorer.text("#turned-readout").startswith(f"point 1 of {count}, phase 10 deg")
    assert len(explorer.all("#turned-events button")) == len(answer["events"])
    assert f"{100 * answer['margins']['lead']:.1f} %" in explorer.text("#turned-outcome")
    assert "push%3D8" in explorer.chromium.current_url
    assert "confirm%3Dyes" in explorer.chromium.current_url
    explorer.wait(lambda: len(explorer.all("#turned-chart .cursor line")) == 6, "not all curves are drawn")
    explorer.choose("#unit", "mm")
    explorer.wait_for_text("#turned-chart", "height z (mm)")
    assert value_of(explorer, "#device-push") == "8"


def test_fields_that_are_left_empty_are_those_of_the_default_device(explorer: Explorer) -> None:
    explorer.click("#tab-device")
    for unit in LengthUnit:
        explorer.choose("#unit", unit.value)
        explorer.wait_for_text("#device-k_tilt-label", f"N {unit.value}/rad")
        document = device_document(default_device().in_unit(unit))
        for name in ("k_lateral", "k_axial", "k_tilt", "k_twist", "centre", "push", "ccw_turn"):
            shown = explorer.one(f"#device-{name}").get_attribute("placeholder")
            value = document[name]
            assert shown == (value if isinstance(value, str) else f"{value:.6g}")
        for name in LIMITS:
            assert name not in document
            assert explorer.one(f"#device-{name}").get_attribute("placeholder") == "any"
        assert value_of(explorer, "#device-about") == document["about"]


def test_a_path_beyond_the_travel_says_so(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED.replace('unit', 'tilt_limit%3D1%26unit')}")
    explorer.wait_for_text("#turned-outcome", "The device has passed its limit of tilt or shift")
    assert value_of(explorer, "#device-tilt_limit") == "1"


def test_a_link_restores_the_path_and_its_point_and_keys_move_it(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}&point=100")
    explorer.wait_for_text("#turned-readout", "point 101 of")
    explorer.wait_for_text("#scene-readout", "point 101 of")
    assert value_of(explorer, "#device-strategy") == "cw"
    first = settled_canvas(explorer)
    explorer.press("#turned-point", Keys.ARROW_RIGHT)
    explorer.wait_for_text("#turned-readout", "point 102 of")
    explorer.press("#turned-back", Keys.ENTER)
    explorer.wait_for_text("#turned-readout", "point 101 of")
    explorer.press("#turned-events button", Keys.END)
    last = explorer.chromium.switch_to.active_element
    last.send_keys(Keys.ENTER)
    phase = str(last.text).split("\n")[0]
    explorer.wait_for_text("#turned-readout", f"phase {phase} deg")
    assert last.get_attribute("aria-current") == "true"
    assert phase.startswith(MINUS)
    assert settled_canvas(explorer) != first
    explorer.wait(lambda: "point=100" not in explorer.chromium.current_url, "the address has no point")
    explorer.click("#tab-state")
    explorer.one("#depth .curve")
    explorer.wait(lambda: not explorer.one("#turned-chart").is_displayed(), "the path is shown in another tab")
    assert explorer.one("#play-stages").is_enabled()


def test_the_path_plays_until_it_is_stopped(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}&point=3")
    explorer.press("#turned-play", Keys.ENTER)
    explorer.wait(lambda: int(value_of(explorer, "#turned-point")) > 8, "the path does not play")
    assert explorer.one("#turned-play").get_attribute("aria-pressed") == "true"
    explorer.press("#turned-play", Keys.ENTER)
    assert explorer.one("#turned-play").get_attribute("aria-pressed") == "false"
    stopped = value_of(explorer, "#turned-point")
    last = explorer.run("return document.querySelector('#turned-point').max")
    explorer.choose("#turned-point", last)
    assert stopped != last
    assert not explorer.one("#turned-on").is_enabled()


def test_a_path_that_is_cancelled_is_not_shown(explorer: Explorer) -> None:
    explorer.open(f"/#{LONG_AT}")
    choose_device(explorer, **LONG)
    explorer.click("#device-compute")
    explorer.wait_for_text("#device-progress-text", "points so far")
    explorer.click("#device-cancel")
    explorer.wait(lambda: not explorer.one("#device-progress").is_displayed(), "the progress stays")
    assert not explorer.one("#turned-outcome").is_displayed()
    assert explorer.one("#depth svg").is_displayed()
    explorer.wait(lambda: "assembly" not in explorer.run("return location.hash"), "the link asks for the path")
    explorer.wait(lambda: computing(explorer.address) == 0, "the path is computed on")


def test_every_flag_of_a_path_has_its_words(repository_root: Path) -> None:
    source = (repository_root / "service/explorer/page/js/turned_path.js").read_text()
    reasons = source.split("const REASONS = {")[1].split("};")[0]
    assert set(re.findall(r"^  (\w+): ", reasons, re.MULTILINE)) == set(SettledFlag)


def test_a_refused_value_leaves_the_path_that_is_shown(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}&point=3")
    explorer.wait_for_text("#turned-readout", "point 4 of")
    choose_device(explorer, k_tilt="-5")
    explorer.click("#device-compute")
    explorer.wait_for_text("#device-k_tilt-fault", "-5.0 is not valid: a stiffness >= 0")
    assert explorer.one("#turned-outcome").is_displayed()
    explorer.wait_for_text("#turned-readout", "point 1 of")
    assert explorer.one("#device-stale").is_displayed()
    assert len(explorer.complaints()) == 1


def test_what_is_not_valid_is_said_beside_its_field(explorer: Explorer) -> None:
    explorer.click("#tab-device")
    choose_device(explorer, k_tilt="-5")
    explorer.click("#device-compute")
    explorer.wait_for_text("#device-k_tilt-fault", "-5.0 is not valid: a stiffness >= 0")
    assert explorer.one("#device-k_tilt").get_attribute("aria-invalid") == "true"
    choose_device(explorer, k_tilt="", mu="much")
    explorer.click("#device-compute")
    explorer.wait_for_text("#device-mu-fault", "much is not valid")
    assert explorer.text("#device-k_tilt-fault") == ""
    assert not explorer.one("#turned-outcome").is_displayed()
    complaints = explorer.complaints()
    assert len(complaints) == 2
    assert all("400 (Bad Request)" in one for one in complaints)
