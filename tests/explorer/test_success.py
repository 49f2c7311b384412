"""The explorer's tab of success maps: filled in while it is computed, its paths played, two maps side by side."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import pytest
from selenium.webdriver.common.keys import Keys

from harness.browser import Explorer
from tests.explorer.test_device import choose_device, value_of
from threadstate.device.assemble import assemble_pose
from threadstate.device.strategy import Strategy
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

CELLS = 9
"""Orientations of the library's grid."""
COMPUTED = "tab=success&nut=off&success=phases%3D1%26roll%3D0%26pitch%3D0%26phase%3D0%26strategy%3Dcw%26unit%3Din"


OUT_OF_TIME = """
window.threadstateFetch = window.fetch;
const late = () => new Response(
  JSON.stringify({ type: '/docs/problems#out-of-time', title: 'Out of time', status: 503, detail: 'no answer' }),
  { status: 503, headers: { 'Content-Type': 'application/problem+json' } },
);
window.fetch = (address, options) => {
  const poses = String(address).includes('/v1/outcomes') ? JSON.parse(options.body).poses : [];
  const isLate = poses.some(({ roll, pitch, phase }) => roll === 4 && pitch === 4 && phase === 180);
  return isLate ? Promise.resolve(late()) : window.threadstateFetch(address, options);
};
"""
"""Has the service be out of time for the path from roll 4, pitch 4, phase 180, alone or among others."""


FIRST_PHASE_ALONE = """
const fetched = window.fetch;
window.fetch = (address, options) => {
  const poses = String(address).includes('/v1/outcomes') ? JSON.parse(options.body).poses : [];
  return poses.some(({ phase }) => phase !== 0) ? new Promise(() => {}) : fetched(address, options);
};
"""
"""Has the service never answer for paths from other phases than 0."""


DRAWN_AS_WIDE_AS_ITS_FRAME = """
const frame = document.querySelector('#depth');
return frame.querySelector('svg').viewBox.baseVal.width === frame.clientWidth;
"""


def filled(explorer: Explorer, frame: str = "#success") -> int:
    """How many cells of a map are computed."""
    return len(explorer.all(f"{frame} .cell rect:first-child:not(.none, .partial)"))


def whole(explorer: Explorer) -> None:
    """Wait until the map is computed."""
    explorer.wait(lambda: filled(explorer) == CELLS, "the map is not filled in")
    explorer.wait(lambda: not explorer.one("#success-cancel").is_enabled(), "the map does not end")


def says_other(explorer: Explorer, before: str) -> bool:
    """Whether something else is said of the critical friction than before."""
    return explorer.text("#success-critical") != before


def saved(explorer: Explorer, kind: str, folder: Path) -> str:
    """The text of the file that a button of the tab saves."""
    explorer.chromium.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})
    explorer.click(f'[data-save="success"] button[data-kind="{kind}"]')
    pattern = f"1-4-20-unc_success-map_*.{kind.lower()}"
    # The browser reserves the name by an empty file.
    explorer.wait(lambda: any(path.stat().st_size for path in folder.glob(pattern)), f"no {kind} was saved")
    (path,) = folder.glob(pattern)
    return path.read_text()


def test_from_an_empty_device_to_a_critical_friction(explorer: Explorer) -> None:
    explorer.click("#tab-device")
    choose_device(explorer, strategy="cw", k_tilt="25")
    explorer.click("#tab-success")
    explorer.click("#success-compute")
    explorer.wait(lambda: filled(explorer) > 0, "no cell is filled in")
    whole(explorer)
    words = explorer.text("#success-text")
    found = re.match(r"Of 9 orientations (\d) engage from phase 0 at", words)
    assert found is not None, words
    assert explorer.text("#success-device").startswith("k tilt (N in/rad) 25")
    engaging = explorer.all('#success .cell[aria-label*=": engages"]')
    assert len(engaging) == int(found[1])
    roll, pitch = (float(engaging[0].get_attribute(f"data-{name}") or "nan") for name in ("roll", "pitch"))
    explorer.run("arguments[0].dispatchEvent(new MouseEvent('click', {bubbles: true}))", engaging[0])
    explorer.wait_for_text("#turned-readout", "point ")
    explorer.wait(lambda: int(value_of(explorer, "#turned-point")) > 3, "the path does not play")
    assert explorer.text("#success-cell").startswith("paths from roll")
    explorer.click("#success-critical-find")
    explorer.wait(lambda: "so far" in explorer.text("#success-critical"), "nothing is narrowed down")
    for _ in range(20):
        # A friction takes seconds on a machine that is busy; each has to change what is said.
        before = explorer.text("#success-critical")
        if "so far" not in before:
            break
        explorer.wait(partial(says_other, explorer, before), "no friction is tried")
    last = re.search(r"engages up to μ = ([0-9.]+)", explorer.text("#success-critical"))
    assert last is not None
    assert "success=phases%3D1" in explorer.chromium.current_url
    assert (float(value_of(explorer, "#roll")), float(value_of(explorer, "#pitch"))) == (roll, pitch)
    kept = explorer.text("#success-critical")
    explorer.click("#success-keep")
    explorer.choose("#device-k_tilt", "30")
    explorer.click("#success-compute")
    explorer.wait_for_text("#success-kept-text", kept)
    whole(explorer)
    assert filled(explorer, "#success-kept") == CELLS
    assert explorer.one("#success-critical-find").is_enabled()


def test_a_link_restores_the_map_and_what_it_says_is_what_is_computed(explorer: Explorer, tmp_path: Path) -> None:
    explorer.open(f"/#{COMPUTED}")
    whole(explorer)
    outcome = assemble_pose(quarter_twenty_unc(), 0.0, -4.0, 0.0, strategy=Strategy.CW).outcome
    cell = explorer.one('#success .cell[data-roll="0"][data-pitch="-4"]')
    assert ("engages" in (cell.get_attribute("aria-label") or "")) == (outcome.value == "engaged")
    rows = saved(explorer, "CSV", tmp_path).splitlines()
    assert rows[0].startswith("roll,pitch,phase,mu,outcome,flags,bounded,torque,tilt,shift,end,unit,strategy")
    assert len(rows) == 1 + CELLS
    assert any(row.startswith(f"0,-4,0,0,{outcome.value},") for row in rows[1:])
    assert rows[0].endswith(
        "push,k_lateral,k_axial,k_tilt,k_twist,centre,ccw_turn,tilt_limit,shift_limit,torque_limit,about,device_unit"
    )
    picture = saved(explorer, "SVG", tmp_path)
    assert picture.count("<rect") > CELLS
    rings = re.findall(r'<rect[^>]*stroke-width="[24]px"[^>]*>', picture)
    assert len(rings) == 2 * CELLS
    assert all('visibility="hidden"' in ring for ring in rings)
    assert re.sub("<[^>]*>", " ", picture).count("1/4-20 UNC, the default device;") == 1


def test_a_link_restores_the_square_and_the_device_of_the_map(explorer: Explorer) -> None:
    of_path = "assembly=roll%3D0%26pitch%3D-4%26phase%3D0%26k_tilt%3D80%26unit%3Dmm&success_at=0%20-4"
    explorer.open(f"/#{COMPUTED.replace('strategy', 'centre%3D0.1%26strategy')}&{of_path}")
    whole(explorer)
    explorer.wait_for_text("#success-cell", "paths from roll 0 deg, pitch ")
    assert len(explorer.all("#success .cell.chosen")) == 1
    assert (value_of(explorer, "#device-k_tilt"), float(value_of(explorer, "#device-centre"))) == ("", 0.1)
    assert value_of(explorer, "#device-strategy") == "cw"
    assert not explorer.one("#success-stale").is_displayed()
    explorer.choose("#device-push", "20")
    explorer.click("#tab-state")
    explorer.click("#tab-success")
    explorer.wait(lambda: explorer.one("#success-stale").is_displayed(), "another device is not seen")


def test_what_is_refused_leaves_map_and_path_and_a_curve_that_comes_back_has_its_size(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}&assembly=roll%3D0%26pitch%3D-4%26phase%3D0%26strategy%3Dcw%26unit%3Din")
    whole(explorer)
    explorer.choose("#success-mu", "5")
    explorer.click("#success-compute")
    explorer.wait_for_text("#success-problem", "friction μ is 5; valid: from 0 to 1")
    assert filled(explorer) == CELLS
    explorer.wait(lambda: explorer.one(".panel.turned").is_displayed(), "the path is not shown")
    explorer.click("#tab-device")
    explorer.choose("#device-push", "-1")
    explorer.wait(lambda: explorer.one("#device-stale").is_displayed(), "the path is not said to be of other values")
    explorer.click("#device-compute")
    explorer.wait_for_text("#panel-device", "a force > 0")
    assert explorer.one(".panel.turned").is_displayed()
    explorer.click("#tab-state")
    explorer.wait(lambda: explorer.one("#depth svg").is_displayed(), "the curve does not come back")
    explorer.wait(lambda: bool(explorer.run(DRAWN_AS_WIDE_AS_ITS_FRAME)), "the curve has another size than its frame")
    assert ["400" in one for one in explorer.complaints()] == [True, True]


def test_by_keys_alone_a_cell_is_chosen_and_a_map_kept_beside_another(explorer: Explorer) -> None:
    explorer.open(f"/#{COMPUTED}")
    whole(explorer)
    explorer.press('#success .cell[tabindex="0"]', Keys.ARROW_DOWN)
    focused = explorer.chromium.switch_to.active_element
    assert (focused.get_attribute("data-roll"), focused.get_attribute("data-pitch")) == ("0", "-4")
    focused.send_keys(Keys.ENTER)
    explorer.wait_for_text("#success-cell", "paths from roll 0")
    explorer.press("#success-keep", Keys.ENTER)
    explorer.wait(lambda: filled(explorer, "#success-kept") == CELLS, "the kept map is not there")
    explorer.choose("#success-mu", "0.4")
    explorer.press("#success-compute", Keys.ENTER)
    explorer.wait_for_text("#success-text", "μ = 0.4")
    assert "kept_success=" in explorer.chromium.current_url
    explorer.press("#success-cancel", Keys.ENTER)
    explorer.wait(lambda: not explorer.one("#success-cancel").is_enabled(), "the map is not cancelled")
    explorer.press("#success-drop", Keys.ENTER)
    explorer.wait(lambda: filled(explorer, "#success-kept") == 0, "the kept map is not dropped")


def test_a_path_that_takes_too_long_is_undecided_and_the_map_goes_on(explorer: Explorer) -> None:
    explorer.open("/#tab=success")
    explorer.run(OUT_OF_TIME)
    explorer.choose("#success-phases", "2")
    explorer.click("#success-compute")
    whole(explorer)
    explorer.run("window.fetch = window.threadstateFetch")
    assert explorer.text("#success-problem") == ""
    cell = explorer.one('#success .cell[data-roll="4"][data-pitch="4"]')
    explorer.run("arguments[0].dispatchEvent(new MouseEvent('click', {bubbles: true}))", cell)
    explorer.wait_for_text("#success-cell", "paths from roll 4")
    (answered, not_answered) = explorer.all("#success-cell tbody tr")
    assert "undecided" not in answered.text
    assert "undecided, not followed to its end" in not_answered.text


def test_paths_from_the_first_phase_come_first_as_small_squares(explorer: Explorer) -> None:
    explorer.open("/#tab=success")
    explorer.run(FIRST_PHASE_ALONE)
    explorer.choose("#success-phases", "2")
    explorer.click("#success-compute")
    explorer.wait(lambda: len(explorer.all("#success .cell rect.partial")) == CELLS, "no small squares")
    assert explorer.text("#success-text").startswith("From phase 0 alone 9 orientations are computed so far (of 9)")
    assert explorer.one("#success-bar").get_attribute("value") == str(CELLS)
    assert explorer.one("#success-bar").get_attribute("max") == str(2 * CELLS)
    words = explorer.one('#success .cell[data-roll="0"][data-pitch="0"]').get_attribute("aria-label") or ""
    assert words.endswith("from phase 0 deg so far")
    explorer.click("#success-cancel")


def test_a_stored_map_is_shown_at_each_of_its_frictions_and_by_a_link(explorer: Explorer) -> None:
    explorer.click("#tab-success")
    explorer.wait(lambda: len(explorer.all("#success-stored option")) == 5, "the stored maps are not listed")
    _, of_matrix, _, without, with_friction = explorer.all("#success-stored option")
    assert not of_matrix.is_enabled()
    assert "a whole matrix" in of_matrix.text
    assert without.text == "1: μ 0, 2 phases, the default device; ccw, then cw"
    explorer.choose("#success-stored", without.get_attribute("value") or "")
    explorer.wait_for_text("#success-text", "Of 9 orientations 9 engage from each of 2 phases at μ = 0.")
    explorer.choose("#success-stored", with_friction.get_attribute("value") or "")
    explorer.wait_for_text("#success-text", "Of 9 orientations 0 engage from each of 2 phases at μ = 0.2.")
    assert explorer.text("#success-device") == "stored map 1: the default device; ccw, then cw"
    assert explorer.one('#success .cell[data-roll="1"][data-pitch="-1"]')
    explorer.wait(lambda: "mu%3D0.2" in explorer.chromium.current_url, "the link does not have the map")
    link = explorer.chromium.current_url
    explorer.choose("#success-stored", "")
    explorer.wait(lambda: not explorer.all("#success .cell"), "the map is not left")
    for changed, words in (
        (link, "0 engage"),
        (link.replace("phases%3D2", "phases%3D4"), "another one than that of the link"),
    ):
        explorer.chromium.get("about:blank")
        explorer.chromium.get(changed)
        explorer.wait_for_text("#panel-success", words)


def test_what_is_not_valid_is_said(explorer: Explorer) -> None:
    explorer.click("#tab-success")
    explorer.choose("#success-mu", "2")
    explorer.click("#success-compute")
    explorer.wait_for_text("#success-problem", "friction μ is 2; valid: from 0 to 1")
    assert filled(explorer) == 0
    assert ["400" in one for one in explorer.complaints()] == [True]
