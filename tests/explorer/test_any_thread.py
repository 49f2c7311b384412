"""The explorer beyond one grid: any tilt, one's own thread, links, Back and Forward, what was measured and observed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from harness.browser import Explorer, phase_of, resize
from harness.databases import Databases
from tests.explorer.conftest import GRID, OpenPage
from tests.explorer.test_explorer import MINUS, length_shown, shown_numbers, wait_for_scene
from tests.service.own_library import OWN_PAIR, store_own_library
from tests.service_thread import service_thread
from tests.stored_histories.history_library import histories_of_grid, store_histories
from threadstate.library.grid import Grid
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose

pytestmark = pytest.mark.slow

UNC, OWN = 1, 2


@pytest.fixture(scope="module")
def two_libraries(sqlite_databases: Databases) -> Iterator[str]:
    """The address of a service over 1/4-20 UNC and, published later, an M6x1 that no catalogue has."""
    database = sqlite_databases.migrated()
    store_histories(database, GRID, histories_of_grid(GRID))
    assert store_own_library(database, Grid(4.0, 4.0, 10.0), SolveOptions()) == OWN
    with service_thread(database) as address:
        yield address


@pytest.fixture
def page(open_page: OpenPage, two_libraries: str, request: pytest.FixtureRequest) -> Iterator[Explorer]:
    """The explorer over both."""
    with open_page.explorer(two_libraries, request.session) as page:
        yield page


def wait_for_pose(page: Explorer, roll: float, pitch: float, phase: float) -> None:
    shown = f"roll {roll:g} deg, pitch {pitch:g} deg, phase {phase:g} deg"
    page.wait_for_text("#state", shown.replace("-", MINUS))


def wait_for_address(page: Explorer, part: str) -> None:
    page.wait(lambda: part in page.chromium.current_url, f"the address does not have {part}")


def test_ones_own_thread_is_shown_and_solved_beside_the_grid_and_snapped_to(page: Explorer) -> None:
    page.open(f"/#library={OWN}&roll=0&pitch=-4&phase=12.5")
    wait_for_pose(page, 0, -4, 12.5)
    state = solve_pose(OWN_PAIR, 0.0, -4.0, 12.5)
    assert shown_numbers(page)["first contact at"] == length_shown(state.poses[0].translation[2], "mm")
    wait_for_scene(page, "roll 0, pitch -4, phase 12.5 deg")
    page.wait_for_text("#depth", "snap: falls")
    page.click("#to-snap")
    page.wait_for_text("#depth-readout", "in the clearance window")
    for tab, shown in (("regions", "#disks .disk"), ("follows", "#follows .card"), ("network", "#network .formation")):
        page.click(f"#tab-{tab}")
        page.one(shown)


def test_libraries_are_switched_without_a_reload(page: Explorer) -> None:
    page.run("window.stays = true")
    page.wait(lambda: len(page.all("#library option")) == 2, "not all libraries are listed")
    texts = [option.text for option in page.all("#library option")]
    assert texts == ["2 (latest): M6x1, ±4 by 4°, phase by 10°, exact", "1: 1/4-20 UNC, ±4 by 4°, phase by 5°, exact"]
    page.choose("#roll", "2.5")
    wait_for_pose(page, 2.5, -4, 10)
    page.choose("#library", str(UNC))
    page.wait_for_text("#map-phase", "at phase 10 of the grid.")
    wait_for_address(page, f"library={UNC}&roll=2.5")
    page.choose("#phase", "15")
    page.wait_for_text("#map-phase", "at phase 15 of the grid.")
    page.chromium.back()
    wait_for_address(page, f"library={OWN}&roll=2.5")
    page.choose("#phase", "15")
    page.wait_for_text("#map-phase", "at phase 20 of the grid; you are at 15.")
    assert page.run("return window.stays") is True


def test_the_library_of_a_link_is_asked_for_once(page: Explorer) -> None:
    page.addresses_asked()
    page.open(f"/#library={UNC}&unit=mm")
    page.one("#depth .curve")
    asked = page.addresses_asked()
    assert asked.count(f"{page.address}/v1/libraries/{UNC}?unit=mm") == 1


def test_a_library_that_is_not_there_leaves_the_present_one(page: Explorer) -> None:
    page.run("location.hash = '#library=99&roll=0&pitch=-4&phase=20'")
    page.wait_for_text("#toast", "library 99 is not published here")
    wait_for_address(page, f"library={OWN}&roll=0&pitch=-4&phase=20")
    page.complaints()


def test_any_tilt_is_computed_and_lies_between_the_squares(page: Explorer) -> None:
    page.choose("#roll", "2.5")
    page.choose("#pitch", "-1.2")
    page.choose("#phase", "357")
    wait_for_pose(page, 2.5, -1.2, 357)
    state = solve_pose(OWN_PAIR, 2.5, -1.2, 357.0)
    assert shown_numbers(page)["first contact at"] == length_shown(state.poses[0].translation[2], "mm")
    page.one("#map .cross")
    page.wait_for_text("#map-readout", f"roll 2.5, pitch {MINUS}1.2 deg lies between the squares")
    page.wait_for_text("#depth-readout", "from")
    heights = page.fetched(f"/v1/histories/2.5/-1.2/heights?library={OWN}")["heights"]
    assert heights["roll"] == 2.5
    page.click("#tab-follows")
    page.one("#path .step")


def test_a_link_keeps_any_tilt_exactly_and_says_what_is_not_valid(page: Explorer) -> None:
    page.open("/#roll=2.5&pitch=-1.2&phase=357.25")
    wait_for_pose(page, 2.5, -1.2, 357.25)
    link = page.chromium.current_url
    assert "roll=2.5&pitch=-1.2&phase=357.25" in link
    page.open("/" + link.removeprefix(page.address + "/"))
    wait_for_pose(page, 2.5, -1.2, 357.25)
    assert page.chromium.current_url == link
    page.open("/#roll=12&pitch=-1.2&phase=400&tab=network")
    page.wait_for_text(
        "#toast", "roll in the link is 12; valid: -10 to 10 deg. phase 400 deg is 40 deg within the turn"
    )
    wait_for_pose(page, 0, -1.2, 40)
    wait_for_address(page, "tab=network")


def test_fields_say_what_they_do_not_take(page: Explorer) -> None:
    page.choose("#phase", "400")
    page.wait_for_text("#toast", "phase 400 deg is 40 deg within the turn")
    page.choose("#phase", "-5")
    page.wait_for_text("#toast", "phase -5 deg is 355 deg within the turn")
    assert phase_of(page) == 355
    page.choose("#roll", "10.5")
    page.wait_for_text("#toast", "roll is 10.5; valid: -10 to 10 deg")
    assert page.run("return document.querySelector('#roll').value") == "0"
    page.choose("#roll", "-10")
    wait_for_pose(page, -10, -4, 355)


def test_back_and_forward_take_what_one_went_to_and_not_what_moved(page: Explorer) -> None:
    page.choose("#phase", "20")
    wait_for_address(page, "phase=20")
    page.choose("#roll", "4")
    page.choose("#phase", "30")
    wait_for_address(page, "roll=4&pitch=-4&phase=30")
    page.click("#tab-network")
    wait_for_address(page, "tab=network")
    page.chromium.back()
    wait_for_address(page, "roll=4&pitch=-4&phase=30")
    wait_for_pose(page, 4, -4, 30)
    assert page.one("#tab-state").get_attribute("aria-selected") == "true"
    page.chromium.back()
    wait_for_pose(page, 0, -4, 20)
    page.chromium.forward()
    wait_for_pose(page, 4, -4, 30)
    assert page.run("return document.querySelector('#roll').value") == "4"


def test_another_library_is_shown_beside(page: Explorer) -> None:
    page.click("#compare")
    page.choose("#beside-library", str(UNC))
    page.choose("#beside-roll", "-4")
    page.one("#depth path.beside")
    page.wait_for_text("#snaps", f"roll {MINUS}4, pitch {MINUS}4 deg of 1/4-20 UNC")
    page.wait_for_text("#depth", f"first contact at roll {MINUS}4, pitch {MINUS}4 deg of 1/4-20 UNC")
    for library, place in ((OWN, "0/-4"), (UNC, "-4/-4")):
        snap = page.fetched(f"/v1/libraries/{library}/histories/{place}/intervals?unit=mm")["history"]["snap"]
        assert length_shown(snap["fall"], "mm") in page.text("#snaps")
    wait_for_address(page, f"beside_library={UNC}&beside_roll=-4&beside_pitch=-4")
    page.click("#compare")
    page.wait(lambda: not page.all("#depth path.beside"), "the other curve stays")


def test_measured_poses_are_listed_and_marked_and_lead_there(page: Explorer, tmp_path: Path) -> None:
    page.click("#tab-poses")
    table = tmp_path / "poses.csv"
    table.write_text("roll,pitch,phase\n2.5,-1.2,357\n0,-4,40\n12,0,0\n")
    page.one("#poses-file").send_keys(str(table))
    page.wait_for_text("#poses-faults", "line 4: roll is 12; valid: -10 to 10 deg")
    page.wait(lambda: len(page.all("#poses-list tbody tr")) == 2, "the poses are not listed")
    assert (len(page.all("#map .pose")), len(page.all("#depth .pose")), len(page.all("#depth .pose.here"))) == (2, 2, 1)
    page.click("#poses-list tbody tr:first-child button")
    page.wait(lambda: phase_of(page) == 357, "the pose is not gone to")
    assert page.chromium.switch_to.active_element.get_attribute("aria-pressed") == "true"
    page.one("#map .cross")
    wait_for_address(page, "poses=2.5%2C-1.2%2C357%3B0%2C-4%2C40")
    page.click("#poses-clear")
    page.wait(lambda: not page.all("#map .pose"), "the marks stay")


def test_threads_are_compared_and_any_other_is_shown_in_section(page: Explorer) -> None:
    page.click("#tab-threads")
    page.wait(lambda: len(page.all("#compared thead button")) == 2, "the libraries are not compared")
    found = page.fetched(f"/v1/compare?libraries={OWN},{UNC}")["libraries"]
    assert [one.text for one in page.all("#compared thead button")] == [
        f"{one['library']}: {one['designation']}" for one in found
    ]
    rows = {one.find_element("css selector", "th").text: one.text for one in page.all("#compared tbody tr")}
    assert f"{found[0]['snaps']} of 9 {found[1]['snaps']} of 9" in rows["snaps"]
    assert f"{100.0 * found[1]['fall']['median']:.1f} %" in rows["steepest fall"]

    def pictures() -> list[int]:
        return page.run("return [...document.querySelectorAll('#profiles img')].map((one) => one.naturalWidth)")

    page.wait(lambda: [width > 100 for width in pictures()] == [True], "the library's thread is not shown")
    page.choose("#thread", "m6 at 7")
    page.one("#thread").submit()
    page.wait_for_text("#thread-problem", "position in the tolerance is '7'")
    assert ["400 (Bad Request)" in complaint for complaint in page.complaints()] == [True]
    page.choose("#thread", "1/4-16 acme with sharp corners")
    page.one("#thread").submit()
    page.wait(lambda: [width > 100 for width in pictures()] == [True, True], "the other thread is not shown")
    assert page.text("#thread-problem") == ""
    wait_for_address(page, "thread=1%2F4-16%20acme%20with%20sharp%20corners")
    page.click("#compared thead th:last-child button")
    wait_for_address(page, f"library={UNC}")
    page.wait(
        lambda: page.text('#compared thead button[aria-pressed="true"]').startswith(f"{UNC}: "),
        "the library that was chosen is not marked",
    )
    page.one('#profiles img[alt*="1/4-20 UNC"]')
    page.click("#thread-clear")
    page.wait(lambda: len(pictures()) == 1, "the other thread stays")


def test_what_was_observed_is_located(page: Explorer) -> None:
    page.click("#tab-locate")
    page.choose('#locate-form [name="class"]', "unstable_two_point")
    page.choose('#locate-form [name="nut-0"]', "crest")
    page.wait_for_text("#located", "of all poses remain")
    query = "class=unstable_two_point&contact=*:*:crest:*"
    found = page.fetched(f"/v1/libraries/{OWN}/network/locate?{query}")["location"]
    page.wait(
        lambda: len(page.all("#located tbody tr")) == len(page.all("#map .remains")) == found["orientations"] > 0,
        "not all orientations are listed and marked",
    )
    page.click("#located tbody tr:last-child button")
    page.wait_for_text("#state", "unstable two-point")
    page.open("/" + page.chromium.current_url.removeprefix(page.address + "/"))
    page.wait_for_text("#located", "of all poses remain")
    assert page.run("return document.querySelector('#locate-form').elements['nut-0'].value") == "crest"


def test_the_map_follows_the_phase_that_is_played(page: Explorer) -> None:
    page.wait_for_text("#map-phase", "at phase 10 of the grid.")
    page.click("#play-phase")
    shown = {page.text("#map-phase")}

    def moves() -> bool:
        shown.add(page.text("#map-phase").partition(";")[0])
        return len(shown) > 3

    page.wait(moves, "the map stands still")
    page.click("#play-phase")


def test_the_axes_are_shown_and_put_away(page: Explorer) -> None:
    page.click("#show-axes")
    page.wait(
        lambda: page.run("return document.querySelector('#axes img').naturalWidth") > 0, "the picture is not there"
    )
    assert page.one("#axes").is_displayed()
    page.click("#hide-axes")
    assert not page.one("#axes").is_displayed()


def test_a_tolerance_gives_the_range_of_the_falls_and_nothing_is_wider_than_a_small_screen(page: Explorer) -> None:
    resize(page.chromium, 390, 844)
    try:
        page.open(f"/#library={OWN}&beside_library={UNC}&beside_roll=0&beside_pitch=-4&poses=2.5,-1.2,357")
        page.one("#depth path.beside")
        page.choose("#tolerance", "0.1")
        page.wait_for_text("#falls", "within ±0.1 deg: snaps, falls")
        found = page.received(f"/v1/histories/0/-4/falls?library={OWN}&tolerance=0.1&unit=mm")["range"]
        assert f"falls {found['fall'][0]:.3f} to {found['fall'][1]:.3f} mm" in page.text("#falls")
        wait_for_address(page, "tolerance=0.1")
        assert page.run("return document.querySelector('#beside-library').value") == str(UNC)
        for width in (390, 768):
            resize(page.chromium, width, 844)
            for tab in ("state", "regions", "follows", "network", "locate", "poses", "threads"):
                page.click(f"#tab-{tab}")
                assert (
                    page.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth") <= 0
                ), (width, tab)
        page.choose("#tolerance", "")
        page.wait(lambda: not page.one("#falls").is_displayed(), "the range stays")
    finally:
        resize(page.chromium, 1280, 800)
