"""The explorer by keys alone: everything is reached, the focus is seen and stays where it was led."""

from __future__ import annotations

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from harness.browser import Explorer, phase_of
from tests.explorer.test_device import COMPUTED

pytestmark = pytest.mark.slow

FOCUSED = """
const at = document.activeElement;
const all = [...document.querySelectorAll('*')];
const outlined = [at, ...at.querySelectorAll('.box, .frame-in, .reach')].some((one) => {
  const { outlineStyle, outlineWidth, strokeWidth, stroke } = getComputedStyle(one);
  const drawn = one !== at && parseFloat(strokeWidth) >= 2 && stroke !== 'none';
  return drawn || (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2);
});
const within = at.closest(arguments[0]) !== null;
return { index: all.indexOf(at), within, name: at.id || at.outerHTML.slice(0, 80), visible: outlined };
"""
"""Which element has the focus, whether it is within a selector, and whether that is seen."""


INTERACTIVE = """
return [...document.querySelectorAll('a, button, select, input, textarea, [tabindex="0"]')]
  .filter((one) => !one.disabled && one.tabIndex >= 0 && one.checkVisibility() && one.closest(arguments[0])).length
"""
"""How many elements within a selector can have the focus."""
BEFORE_PANEL = "#tabs [tabindex='0']"


def test_keyboard_reaches_everything_and_its_focus_is_seen(explorer: Explorer) -> None:
    explorer.one("#panel-state table")
    explorer.one("#scene canvas")
    explorer.run("document.activeElement.blur(); document.body.tabIndex = -1; document.body.focus()")
    explorer.run("document.body.removeAttribute('tabindex')")
    check_all_are_reached(explorer, "body")


@pytest.mark.parametrize("tab", ["device", "regions", "follows", "network", "locate", "poses", "threads"])
def test_keyboard_reaches_everything_in_a_tab(explorer: Explorer, tab: str) -> None:
    explorer.click(f"#tab-{tab}")
    explorer.one(f"#panel-{tab} :is(svg, table, select, textarea)")
    explorer.run("document.querySelector(arguments[0]).focus()", BEFORE_PANEL)
    check_all_are_reached(explorer, f"#panel-{tab}")


def test_keyboard_reaches_everything_about_the_path_of_a_held_bolt(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}&point=100")
    explorer.one("#turned-chart .curve")
    explorer.run("document.querySelector('#camera-reset').focus()")
    check_all_are_reached(explorer, ".panel.turned")


def check_all_are_reached(explorer: Explorer, within: str) -> None:
    """The next tabs, as many as there are elements within, lead to each of them, and it is seen."""
    interactive = explorer.run(INTERACTIVE, within)
    seen = []
    for _ in range(interactive):
        ActionChains(explorer.chromium).send_keys(Keys.TAB).perform()
        seen.append(explorer.run(FOCUSED, within))
    assert [one["name"] for one in seen if not one["visible"]] == []
    assert len({one["index"] for one in seen if one["within"]}) == interactive


def test_keys_choose_and_follow(explorer: Explorer) -> None:
    explorer.press('#map .cell[aria-selected="true"]', Keys.ARROW_UP)
    explorer.wait_for_text("#state", "roll 0 deg, pitch 0 deg")
    focused = explorer.chromium.switch_to.active_element
    assert (focused.get_attribute("data-roll"), focused.get_attribute("data-pitch")) == ("0", "0")
    explorer.click("#tab-follows")
    explorer.press('#follows .card[data-move="ccw"]', Keys.ENTER)
    explorer.wait(lambda: phase_of(explorer) != 10, "Enter does not follow")
    explorer.click("#tab-network")
    explorer.press('#network .formation[aria-selected="true"]', Keys.ARROW_DOWN)
    key = explorer.chromium.switch_to.active_element.get_attribute("data-key")
    explorer.chromium.switch_to.active_element.send_keys(Keys.ENTER)
    explorer.wait(
        lambda: explorer.one('#network .formation[aria-selected="true"]').get_attribute("data-key") == key,
        "Enter does not follow",
    )


def test_focus_that_keys_have_led_on_stays_when_another_formation_is_marked(explorer: Explorer) -> None:
    explorer.click("#tab-network")
    marked = explorer.one('#network .formation[aria-selected="true"]')
    before = marked.get_attribute("data-key")
    marked.send_keys(Keys.ARROW_DOWN)
    led_to = explorer.chromium.switch_to.active_element.get_attribute("data-key")
    assert led_to != before
    explorer.choose("#phase", "200")
    explorer.wait(
        lambda: explorer.one('#network .formation[aria-selected="true"]').get_attribute("data-key") != before,
        "another formation is not marked",
    )
    assert explorer.chromium.switch_to.active_element.get_attribute("data-key") == led_to
    stops = explorer.all('#network .formation[tabindex="0"]')
    assert [one.get_attribute("data-key") for one in stops] == [led_to]


def test_help_is_shown_at_the_focus_and_hidden_by_escape(explorer: Explorer) -> None:
    explorer.run("document.querySelector('.panel.phase button.help').focus()")
    explorer.wait_for_text("#help:not([hidden])", "the descent with the steepest fall")
    assert explorer.run("return document.activeElement.getAttribute('aria-describedby')") == "help"
    ActionChains(explorer.chromium).send_keys(Keys.ESCAPE).perform()
    assert not explorer.one("#help").is_displayed()


def test_help_does_not_stay_where_something_was_chosen(explorer: Explorer) -> None:
    button = explorer.one("#zoom-in")
    explorer.run("arguments[0].dataset.help = 'Shows less.'", button)
    ActionChains(explorer.chromium).move_to_element(button).perform()
    explorer.wait_for_text("#help:not([hidden])", "Shows less.")
    button.click()
    assert not explorer.one("#help").is_displayed()


def test_keys_move_the_phase_and_zoom_in_the_picture_of_the_depth(explorer: Explorer) -> None:
    explorer.one("#depth .curve")
    explorer.run("document.querySelector('#depth svg').focus()")
    keys = ActionChains(explorer.chromium)
    keys.send_keys(Keys.ARROW_RIGHT).key_down(Keys.SHIFT).send_keys(Keys.ARROW_LEFT).key_up(Keys.SHIFT).perform()
    assert phase_of(explorer) == 325
    ActionChains(explorer.chromium).send_keys("+").perform()
    explorer.wait(lambda: "span=180" in explorer.chromium.current_url, "the picture is not zoomed")
    ActionChains(explorer.chromium).send_keys("0").perform()
    explorer.wait(lambda: "span=" not in explorer.chromium.current_url, "the whole turn is not shown")


def test_arrows_step_the_tilts_through_the_grid(explorer: Explorer) -> None:
    explorer.one("#roll").send_keys(Keys.ARROW_UP)
    explorer.wait_for_text("#state", "roll 4 deg")
    explorer.one("#pitch").send_keys(Keys.ARROW_UP)
    explorer.wait_for_text("#state", "pitch 0 deg")
