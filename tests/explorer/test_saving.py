"""Pictures, tables and lines that are taken from the page."""

from __future__ import annotations

import csv
import io
import json
import shlex
import urllib.request
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest

from harness.browser import Explorer
from tests.explorer.test_explorer import choose_pose, wait_for_scene
from threadstate.client.models.states import State

pytestmark = pytest.mark.slow

PNG = b"\x89PNG\r\n\x1a\n"
TABS = {"disks": "regions", "follows": "follows", "path": "follows", "network": "network"} | {
    "state": "state",
    "compared": "threads",
}
Save = Callable[[str, str], bytes]


@pytest.fixture
def save(explorer: Explorer, tmp_path: Path) -> Save:
    """Saves a panel's picture or table by its button; the bytes of the file."""
    explorer.chromium.execute_cdp_cmd(
        "Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)}
    )
    choose_pose(explorer, -4, 0, 130)
    wait_for_scene(explorer, "roll -4, pitch 0, phase 130 deg")

    def save(panel: str, kind: str) -> bytes:
        if panel in TABS:
            explorer.click(f"#tab-{TABS[panel]}")
            explorer.one(f"#panel-{TABS[panel]} :is(svg, table)")
        explorer.click(f'[data-save="{panel}"] button[data-kind="{kind}"]')
        pattern = f"1-4-20-unc_*_roll-4_pitch0_phase130*.{kind.lower()}"
        # The browser reserves the name by an empty file.
        explorer.wait(
            lambda: any(path.stat().st_size for path in tmp_path.glob(pattern)), f"no {kind} of {panel} was saved"
        )
        (path,) = tmp_path.glob(pattern)
        content = path.read_bytes()
        path.unlink()
        return content

    return save


def test_pictures_are_saved_as_svg_and_png(save: Save) -> None:
    for panel in ("map", "phase", "disks", "follows", "path", "network"):
        root = ET.fromstring(save(panel, "SVG"))
        elements = list(root.iter())
        assert len(elements) > 20
        assert not [one for one in elements if {"class", "style", "tabindex"} & set(one.attrib)]
        assert all(one.attrib["font-family"] for one in elements if one.tag.endswith("}text"))
        assert "var(" not in ET.tostring(root, encoding="unicode")
        assert save(panel, "PNG").startswith(PNG)


def test_the_path_of_a_held_bolt_is_saved(save: Save, explorer: Explorer) -> None:
    explorer.click("#tab-device")
    explorer.click("#device-reset")
    explorer.click("#device-compute")
    explorer.one("#turned-chart .curve")
    assert "curve" not in save("turned", "SVG").decode()
    assert save("turned", "PNG").startswith(PNG)
    head, *rows = list(csv.reader(io.StringIO(save("turned", "CSV").decode())))
    assert [head[0], head[1], head[2]] == ["phase_deg", "z_in", "torque_N_in"]
    assert float(rows[0][0]) == 130
    assert len(rows) == int(explorer.run("return document.querySelector('#turned-point').max")) + 1


def test_solids_are_saved_as_png(save: Save) -> None:
    content = save("scene", "PNG")
    assert content.startswith(PNG)
    assert len(content) > 5000


def test_tables_are_saved_with_the_numbers_of_the_interface(save: Save, explorer: Explorer) -> None:
    def rows(panel: str) -> list[list[str]]:
        return list(csv.reader(io.StringIO(save(panel, "CSV").decode())))

    library = "/v1/libraries/latest"
    heights = explorer.fetched(f"{library}/histories/-4/0/heights")["heights"]
    shown = [[float(cell) if cell else None for cell in row] for row in rows("phase")[1:]]
    columns = (heights["phases"], heights["first_heights"], heights["rest_heights"])
    assert shown == [list(row) for row in zip(*columns, strict=True)]
    classes = {
        (one["roll"], one["pitch"]): one["class"] for one in explorer.fetched(f"{library}/states?phase=130")["states"]
    }
    assert {(float(roll), float(pitch)): name for roll, pitch, name in rows("map")[1:]} == classes
    intervals = explorer.fetched(f"{library}/histories/-4/0/intervals")["history"]["intervals"]
    assert [row[3] for row in rows("disks")[1:]] == [one["formation"]["key"] for one in intervals]
    following = rows("follows")[1:]
    key = explorer.run("return document.querySelector('#follows .card.here').dataset.key")
    assert key in {row[1] for row in following}
    steps = rows("path")[1:]
    assert len(steps) == len(explorer.all("#path .step"))
    formations = explorer.fetched(f"{library}/network/formations")["formations"]
    assert [(row[0], float(row[2])) for row in rows("network")[1:]] == [
        (one["key"], one["share"]) for one in formations
    ]
    ((head, compared), (one,)) = rows("compared"), explorer.fetched("/v1/compare")["libraries"]
    numbers = dict(zip(head, compared, strict=True))
    assert float(numbers["fall_median"]) == one["fall"]["median"]
    assert float(numbers["share_held_at_0.2"]) == one["held"][1]["share"]


def test_table_of_the_state_has_every_number_of_it(save: Save, explorer: Explorer) -> None:
    state = explorer.fetched("/v1/libraries/latest/states/-4/0/130")
    table = list(csv.reader(io.StringIO(save("state", "CSV").decode())))[1:]
    numbers = sorted(float(value) for _, name, value, _ in table if name != "class" and is_number(value))
    assert numbers == sorted(numbers_of(state))


def is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def numbers_of(value: object) -> list[float]:
    """Every number within a document."""
    if isinstance(value, (int, float)):
        return [float(value)]
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [number for one in inner for number in numbers_of(one)]


def copied(explorer: Explorer, button: str) -> str:
    """What a button puts on the clipboard."""
    explorer.chromium.execute_cdp_cmd(
        "Browser.grantPermissions", {"permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]}
    )
    explorer.click(button)
    explorer.wait_for_text("#toast", "on the clipboard")
    return str(explorer.chromium.execute_async_script("navigator.clipboard.readText().then(arguments[0])"))


def test_copied_lines_fetch_the_state_that_is_shown(explorer: Explorer) -> None:
    choose_pose(explorer, -4, 0, 130)
    state = json.loads(copied(explorer, "#copy-json"))
    assert state == explorer.fetched("/v1/libraries/latest/states/-4/0/130")
    _curl, address = shlex.split(copied(explorer, "#copy-curl"))
    with urllib.request.urlopen(address) as answer:
        assert json.load(answer) == state
    found: dict[str, object] = {}
    exec(copied(explorer, "#copy-python"), found)
    shown = found["state"]
    assert isinstance(shown, State)
    assert shown.model_dump(mode="json", by_alias=True) == state
    link = copied(explorer, "#copy-link")
    assert "roll=-4&pitch=0&phase=130" in link
    assert link.startswith(explorer.address)
