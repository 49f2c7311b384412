"""The explorer as its user meets it: in a browser, over a real library."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from harness.browser import Explorer, phase_of, resize

pytestmark = pytest.mark.slow

LIBRARY = "/v1/libraries/latest"
CLASS_NAMES = {
    "unstable_two_point": "unstable two-point",
    "quasi_stable_two_point": "quasi-stable two-point",
    "stable_three_point": "stable three-point",
}
MINUS = "\N{MINUS SIGN}"


def shown_numbers(explorer: Explorer) -> dict[str, str]:
    """The rows of the state panel's first table, by their heads."""
    rows = explorer.run(
        "return [...document.querySelector('#state table').rows]"
        ".map((row) => [...row.cells].map((one) => one.textContent))"
    )
    return dict(rows)


def length_shown(value: float, unit: str = "in") -> str:
    decimals = {"in": 6, "mm": 5}[unit]
    return f"{value:.{decimals}f} {unit}".replace("-", MINUS)


def choose_pose(explorer: Explorer, roll: int, pitch: int, phase: int) -> None:
    """Choose an orientation on the map and a phase by the slider, and wait for its state."""
    explorer.click(f'#map .cell[data-roll="{roll}"][data-pitch="{pitch}"]')
    explorer.choose("#phase-slider", str(phase))
    explorer.wait_for_text("#state", f"roll {roll} deg, pitch {pitch} deg, phase {phase} deg".replace("-", MINUS))


def canvas_content(explorer: Explorer) -> list[int]:
    """The pixels of the scene as they are seen, 64 by 64 of them."""
    canvas = explorer.one("#scene canvas")
    explorer.run("arguments[0].scrollIntoView({block: 'center'})", canvas)
    seen = canvas.screenshot_as_base64
    pixels: list[int] = explorer.chromium.execute_async_script(
        "const [png, done] = arguments; const image = new Image(); image.src = `data:image/png;base64,${png}`;"
        "const small = Object.assign(document.createElement('canvas'), {width: 64, height: 64});"
        "const context = small.getContext('2d'); image.decode().then(() => {"
        "context.drawImage(image, 0, 0, 64, 64); done([...context.getImageData(0, 0, 64, 64).data]) })",
        seen,
    )
    return pixels


def colours_of(pixels: list[int]) -> set[tuple[int, ...]]:
    return {tuple(pixels[k : k + 4]) for k in range(0, len(pixels), 4)}


def wait_for_scene(explorer: Explorer, told: str) -> None:
    """Wait until the scene was drawn with what its label says then."""
    explorer.one("#scene canvas")
    drawn = "return document.querySelector('#scene canvas').getAttribute('aria-label') ?? ''"
    explorer.wait(lambda: told in explorer.run(drawn), f"the scene does not show {told}")


def settled_canvas(explorer: Explorer) -> list[int]:
    """The pixels of the scene once it is drawn: the same at two looks, between which frames go by."""
    looks = [canvas_content(explorer)]

    def is_settled() -> bool:
        frames = "const done = arguments[0]; let left = 30;"
        frames += "const next = () => left-- ? requestAnimationFrame(next) : done();"
        explorer.chromium.execute_async_script(f"{frames} next()")
        looks.append(canvas_content(explorer))
        return looks[-1] == looks[-2]

    explorer.wait(is_settled, "the scene does not settle")
    return looks[-1]


def wait_for_canvas(explorer: Explorer, pixels: list[int]) -> None:
    explorer.wait(lambda: canvas_content(explorer) == pixels, "the canvas is not as it was")


def wait_for_another_canvas(explorer: Explorer, pixels: list[int]) -> None:
    explorer.wait(lambda: canvas_content(explorer) != pixels, "the canvas stays as it was")


def test_an_orientation_and_a_phase_lead_to_the_numbers_that_the_interface_gives(explorer: Explorer) -> None:
    choose_pose(explorer, -4, 0, 180)
    state = explorer.fetched(f"{LIBRARY}/states/-4/0/180")
    shown = shown_numbers(explorer)
    assert shown["class"].startswith(CLASS_NAMES[state["class"]])
    assert shown["first contact at"] == length_shown(state["poses"][0]["translation"][2])
    assert shown["at rest at"] == length_shown(state["poses"][-1]["translation"][2])
    assert shown["drop"].startswith(length_shown(state["drop"]))
    assert explorer.text("#state-line").startswith(CLASS_NAMES[state["class"]])


def test_what_does_not_rest_is_given_no_place(explorer: Explorer) -> None:
    state = explorer.fetched(f"{LIBRARY}/states/4/0/0")
    assert (state["class"], len(state["poses"])) == ("unstable_two_point", 3)
    choose_pose(explorer, 4, 0, 0)
    shown = shown_numbers(explorer)
    assert shown["at rest"] == "ends unstable: does not rest"
    assert "at rest at" not in shown
    ended = "where the procedure ended (no place of rest)"
    assert shown[ended] == length_shown(state["poses"][-1]["translation"][2])
    assert [caption.text for caption in explorer.all("#state caption")][-1] == ended
    wait_for_scene(explorer, "second contact; from here the bolt does not come to rest")
    assert explorer.run("return document.querySelector('#stage').max") == "2"
    assert explorer.all("#depth .cursor .at-first") and not explorer.all("#depth .cursor .at-rest")


def test_every_contact_and_pose_of_a_state_is_shown(explorer: Explorer) -> None:
    choose_pose(explorer, 4, -4, 90)
    state = explorer.fetched(f"{LIBRARY}/states/4/-4/90")
    captions = [caption.text for caption in explorer.all("#state caption")]
    assert len([caption for caption in captions if caption.startswith("contact")]) == len(state["contacts"])
    poses = [caption for caption in captions if caption.startswith(("bolt's pose", "where the procedure ended"))]
    assert len(poses) == len(state["poses"])
    point = f"{state['contacts'][0]['point'][0]:.6f}".replace("-", MINUS)
    assert point in explorer.text("#state")


def test_lengths_follow_the_unit(explorer: Explorer) -> None:
    choose_pose(explorer, -4, 0, 180)
    explorer.choose("#unit", "mm")
    explorer.wait_for_text("#depth", "z (mm)")
    explorer.wait_for_text("#state", " mm")
    state = explorer.fetched(f"{LIBRARY}/states/-4/0/180?unit=mm")
    assert shown_numbers(explorer)["at rest at"] == length_shown(state["poses"][-1]["translation"][2], "mm")
    explorer.open("/")
    explorer.wait_for_text("#depth", "z (mm)")
    explorer.open("/#unit=in")
    explorer.wait_for_text("#depth", "z (in)")


def test_a_phase_beside_the_grid_is_solved(explorer: Explorer) -> None:
    explorer.choose("#phase", "131.25")
    explorer.wait_for_text("#state", "the exact solver, computed now")
    body = {"poses": [{"roll": 0, "pitch": -4, "phase": 131.25}]}
    solved = explorer.chromium.execute_async_script(
        "const [body, done] = arguments; fetch('/v1/solve', {method: 'POST', body: JSON.stringify(body), "
        "headers: {'Content-Type': 'application/json'}}).then((answer) => answer.json()).then(done)",
        body,
    )
    assert shown_numbers(explorer)["first contact at"] == length_shown(
        solved["states"][0]["poses"][0]["translation"][2]
    )


def test_map_shows_each_quantity_with_its_values(explorer: Explorer) -> None:
    entries = explorer.fetched(f"{LIBRARY}/windows")["orientations"]
    (entry,) = [one for one in entries if (one["roll"], one["pitch"]) == (0, -4)]
    explorer.choose("#quantity", "window_width")
    explorer.wait_for_text("#map-readout", f"{entry['windows'][0]['width']:.3f} deg")
    explorer.choose("#quantity", "snap")
    explorer.wait_for_text("#map-readout", f"fall at the snap {length_shown(entry['snap']['fall'])}")
    explorer.choose("#quantity", "steepest")
    explorer.wait_for_text("#map-readout", f"steepest fall {length_shown(entry['steepest'])}")
    explorer.choose("#quantity", "drop")
    explorer.choose("#over", "all")
    summary = explorer.fetched(f"{LIBRARY}/orientations")["orientations"]
    (one,) = [one for one in summary if (one["roll"], one["pitch"]) == (0, -4)]
    explorer.wait_for_text("#map-readout", f"greatest drop {length_shown(one['drop_most'])}")


def test_history_is_fetched_once_and_while_the_phase_moves_the_map_alone_at_its_pace(explorer: Explorer) -> None:
    explorer.open()
    explorer.click('#map .cell[data-roll="4"][data-pitch="4"]')
    explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg")
    history = f"{explorer.address}/v1/libraries/1/histories/4/4?unit=in"
    asked = explorer.addresses_asked()

    def is_fetched() -> bool:
        asked.extend(explorer.addresses_asked())
        return history in asked

    explorer.wait(is_fetched, "the history is not fetched")
    explorer.choose("#phase-slider", "5")
    explorer.wait_for_text("#state", "phase 5 deg")
    explorer.wait_for_text("#map-phase", "at phase 5 of the grid.")
    explorer.addresses_asked()
    explorer.run(MOVE)
    explorer.wait_for_text("#state", "phase 345 deg")
    explorer.wait_for_text("#map-phase", "at phase 345 of the grid.")
    moved = [one.partition("/v1/")[2] for one in explorer.addresses_asked()]
    assert all(one.startswith("libraries/1/states?phase=") for one in moved), moved
    assert len(moved) <= 2, moved
    assert (asked + moved).count(history) == 1


MOVE = """
const slider = document.querySelector('#phase-slider');
for (let phase = 0; phase < 360; phase += 15) {
  slider.value = phase;
  slider.dispatchEvent(new Event('input', { bubbles: true }));
}
"""
"""The phase moved by its slider, as fast as can be."""


def test_motion_is_reduced_where_that_is_preferred(explorer: Explorer) -> None:
    media = {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]}
    explorer.chromium.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
    try:
        choose_pose(explorer, -4, 0, 180)
        explorer.choose("#stage", "0")
        wait_for_scene(explorer, "above the nut")
        explorer.click("#play-stages")
        stages = [explorer.run(STAGE)]
        while stages[-1] < 3:
            stages.append(explorer.run(STAGE))
        assert set(stages) <= {0, 1, 2, 3}
    finally:
        explorer.chromium.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


STAGE = "return Number(document.querySelector('#stage').value)"


def test_depth_shows_intervals_window_and_snap(explorer: Explorer) -> None:
    explorer.wait_for_text("#depth", "snap: falls")
    history = explorer.fetched(f"{LIBRARY}/histories/0/-4/intervals")["history"]
    assert len(explorer.all("#depth .boundary")) == len(history["boundaries"])
    assert len(explorer.all("#depth rect.window")) == len(history["windows"])
    snap = history["snap"]
    assert f"snap: falls {snap['fall']:.4f} in from {snap['from']:.1f}" in explorer.text("#depth")
    assert f"of it {snap['jump']:.4f} at {snap['jump_at']:.2f} deg" in explorer.text("#depth")
    explorer.click("#to-snap")
    explorer.wait_for_text("#depth-readout", "in the clearance window")
    assert 0 < phase_of(explorer) - snap["jump_at"] < 1e-5


def test_where_there_is_no_snap_the_button_says_why(explorer: Explorer) -> None:
    entries = explorer.fetched(f"{LIBRARY}/windows")["orientations"]
    level = next(one for one in entries if one["snap"] is None)
    explorer.click(f'#map .cell[data-roll="{level["roll"]:g}"][data-pitch="{level["pitch"]:g}"]')
    explorer.wait_for_text("#state", f"roll {level['roll']:g} deg".replace("-", MINUS))
    button, reason = explorer.one("#to-snap"), "There is no snap here"
    explorer.wait(lambda: reason in str(button.get_attribute("data-help")), "the button does not say why")
    assert button.get_attribute("aria-disabled") == "true"
    explorer.click("#to-snap")
    explorer.wait_for_text("#toast", reason)
    assert phase_of(explorer) == 10


def test_a_point_of_the_depth_and_of_a_disk_move_the_phase(explorer: Explorer) -> None:
    explorer.wait_for_text("#depth", "snap: falls")
    picture = explorer.one("#depth svg")
    ActionChains(explorer.chromium).move_to_element(picture).click().perform()
    explorer.wait(
        lambda: phase_of(explorer) < 20 or phase_of(explorer) > 330,
        "the phase is not that of the middle of the picture, where the snap is",
    )
    explorer.click("#tab-regions")
    disk = explorer.one("#disks .disk")
    ActionChains(explorer.chromium).move_to_element_with_offset(disk, 0, -60).click().perform()
    explorer.wait(lambda: 60 < phase_of(explorer) < 120, "the phase is not that of the top of the disk")


def test_disks_say_what_touches_at_the_phase(explorer: Explorer) -> None:
    choose_pose(explorer, 4, -4, 0)
    explorer.click("#tab-regions")
    state = explorer.fetched(f"{LIBRARY}/states/4/-4/0")
    explorer.wait_for_text("#disks .at-cursor", " on ")
    lines = [element.text for element in explorer.all("#disks .at-cursor text")]
    assert len([line for line in lines if line != "none"]) == len(state["contacts"])


def test_stages_are_played_and_the_scene_is_orbited(explorer: Explorer) -> None:
    choose_pose(explorer, -4, 0, 180)
    wait_for_scene(explorer, "roll -4, pitch 0, phase 180 deg, third contact")
    at_rest = canvas_content(explorer)
    assert len(colours_of(at_rest)) > 100
    explorer.click("#play-stages")
    wait_for_scene(explorer, "from first contact to second contact")
    wait_for_another_canvas(explorer, at_rest)
    wait_for_scene(explorer, "third contact")
    wait_for_canvas(explorer, at_rest)
    canvas = explorer.one("#scene canvas")
    canvas.send_keys(Keys.ARROW_LEFT, Keys.ARROW_UP, "+")
    wait_for_another_canvas(explorer, at_rest)
    canvas.send_keys("0")
    explorer.run("document.activeElement.blur()")
    wait_for_canvas(explorer, at_rest)


def test_turn_through_phase_is_played_until_it_is_stopped(explorer: Explorer) -> None:
    explorer.one("#scene canvas")
    first = phase_of(explorer)
    explorer.click("#play-phase")
    explorer.wait(lambda: phase_of(explorer) > first + 10, "the bolt does not turn")
    explorer.click("#play-phase")
    assert explorer.one("#play-phase").get_attribute("aria-pressed") == "false"


def test_what_follows_is_followed(explorer: Explorer) -> None:
    choose_pose(explorer, 0, -4, 130)
    explorer.click("#tab-follows")
    key = explorer.one('#follows .card.here[data-move="ccw"]').get_attribute("data-key")
    explorer.click('#follows .card.here[data-move="ccw"]')
    explorer.wait(lambda: phase_of(explorer) != 130, "the phase stays")
    intervals: list[Any] = explorer.fetched(f"{LIBRARY}/histories/0/-4/intervals")["history"]["intervals"]
    phase = phase_of(explorer)
    (here,) = [one for one in intervals if one["start"] <= phase < one["end"]]
    assert here["formation"]["key"] == key


def test_path_leads_to_the_window(explorer: Explorer) -> None:
    choose_pose(explorer, 0, -4, 130)
    explorer.click("#tab-follows")
    explorer.click("#path .step.window")
    explorer.wait_for_text("#depth-readout", "in the clearance window")


def test_network_shows_every_formation_and_the_way_from_here(explorer: Explorer) -> None:
    choose_pose(explorer, 0, -4, 130)
    explorer.click("#tab-network")
    formations = explorer.fetched(f"{LIBRARY}/network/formations")["formations"]
    explorer.one("#network .way .stop")
    assert {one.get_attribute("data-key") for one in explorer.all("#network .formation")} == {
        one["key"] for one in formations
    }
    intervals = explorer.fetched(f"{LIBRARY}/histories/0/-4/intervals")["history"]["intervals"]
    (here,) = [one["formation"] for one in intervals if one["start"] <= 130 < one["end"]]
    chosen = explorer.one('#network .formation[aria-selected="true"]')
    assert chosen.get_attribute("data-key") == here["key"]
    path = explorer.fetched(f"{LIBRARY}/network/paths?from={here['key']}&roll=0&pitch=-4&phase=130")["path"]
    keys = [step["formation"] for step in path["steps"]]
    turns = sum(one != before for before, one in pairwise(keys))
    assert len(explorer.all("#network .way .stop")) == turns
    (far,) = [one for one in formations if one["key"] == path["steps"][-1]["formation"]]
    explorer.click(f'#network .formation[data-key="{far["key"]}"]')
    explorer.wait_for_text("#network-readout", far["text"])
    explorer.wait_for_text("#depth-readout", "in the clearance window")


def test_tabs_are_part_of_the_view_and_obey_arrows(explorer: Explorer) -> None:
    explorer.click("#tab-state")
    explorer.one("#tab-state").send_keys(Keys.ARROW_LEFT)
    explorer.one("#compared table")
    explorer.wait(lambda: "tab=threads" in explorer.chromium.current_url, "the address does not follow the tab")
    explorer.open("/#tab=regions")
    explorer.one("#disks .disk")
    assert [one.get_attribute("id") for one in explorer.all('[role="tabpanel"]') if one.is_displayed()] == [
        "panel-regions"
    ]
    explorer.one("#tab-regions").send_keys(Keys.HOME)
    explorer.one("#state table")


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (1366, 768), (1920, 1080)])
def test_map_depth_and_solids_are_seen_at_once_and_nothing_is_cut(explorer: Explorer, width: int, height: int) -> None:
    resize(explorer.chromium, width, height)
    try:
        explorer.one("#scene canvas")
        explorer.one("#depth .curve")
        for tab in ("state", "regions", "follows", "network", "locate", "poses", "threads"):
            explorer.click(f"#tab-{tab}")
            assert explorer.run(OUTSIDE) == [], tab
    finally:
        resize(explorer.chromium, 1280, 800)


OUTSIDE = """
const panels = [...document.querySelectorAll('.panel')];
const found = [];
const box = (element) => element.getBoundingClientRect();
if (document.documentElement.scrollHeight > innerHeight) found.push('the page is scrolled');
for (const panel of panels) {
  const { left, top, right, bottom } = box(panel);
  if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) found.push(`outside: ${panel.className}`);
  for (const other of panels) {
    const o = box(other);
    if (other !== panel && left < o.right && o.left < right && top < o.bottom && o.top < bottom) found.push('overlap');
  }
  const clipped = [...panel.querySelectorAll(':scope svg text')].filter((text) => {
    const frame = box(text.ownerSVGElement);
    const one = box(text);
    const outside = one.left < frame.left - 1 || one.right > frame.right + 1;
    return one.width > 0 && (outside || one.top < frame.top - 1 || one.bottom > frame.bottom + 1);
  });
  found.push(...clipped.map((text) => `cut: ${text.textContent}`));
}
return found;
"""
"""What lies outside the window, overlaps another panel or is cut by its picture's edge."""


def test_a_link_restores_exactly_the_view(explorer: Explorer) -> None:
    choose_pose(explorer, 4, 0, 200)
    for selector, value in (("#unit", "mm"), ("#quantity", "pivot_offset"), ("#over", "all"), ("#theme", "dark")):
        explorer.choose(selector, value)
    explorer.choose("#nut-look", "glass")
    explorer.choose("#stage", "1.5")
    explorer.one("#scene canvas").send_keys(Keys.ARROW_LEFT, "+")
    explorer.click("#zoom-in")
    explorer.click("#tab-follows")
    explorer.one("#path .step")
    fragment = "quantity=pivot_offset&over=all"
    explorer.wait(lambda: fragment in explorer.chromium.current_url, "the address does not follow")
    explorer.wait(lambda: "span=180" in explorer.chromium.current_url, "the address does not follow the zoom")
    wait_for_scene(explorer, "from first contact to second contact")
    link = explorer.chromium.current_url
    parts = ("#state", "#depth", "#map", "#follows", "#path")
    shown = [explorer.text(one) for one in parts]
    pixels = settled_canvas(explorer)
    explorer.open("/" + link.removeprefix(explorer.address + "/"))
    wait_for_scene(explorer, "from first contact to second contact")
    explorer.wait(
        lambda: [explorer.text(one) for one in parts] == shown,
        "the view is not the same",
    )
    assert explorer.chromium.current_url == link
    wait_for_canvas(explorer, pixels)
