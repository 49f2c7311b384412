"""What axe-core finds on the page: nothing serious, in light and in dark."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from harness.browser import Explorer
from tests.explorer.test_device import COMPUTED

pytestmark = pytest.mark.slow

AXE = Path("node_modules/axe-core/axe.min.js")
GRAVE = ("serious", "critical")
THEMES = ("light", "dark")


def violations(explorer: Explorer, axe: str, within: str = "html", least_passes: int = 11) -> list[str]:
    """Each grave violation that axe-core finds as the page, or what a selector chooses of it, is now."""
    explorer.chromium.execute_cdp_cmd("Runtime.evaluate", {"expression": axe})
    found: dict[str, Any] = explorer.chromium.execute_async_script(
        "axe.run(arguments[0], {resultTypes: ['violations']}).then(arguments[1])", within
    )
    assert len(found["passes"]) >= least_passes
    return [
        f"{one['id']} ({one['help']}): {', '.join(str(node['target']) for node in one['nodes'][:5])}"
        for one in found["violations"]
        if one["impact"] in GRAVE
    ]


@pytest.mark.parametrize("theme", THEMES)
def test_axe_finds_nothing_serious(explorer: Explorer, repository_root: Path, theme: str) -> None:
    explorer.choose("#theme", theme)
    for selector in ("#scene canvas", "#depth .curve", "#state table"):
        explorer.one(selector)
    assert violations(explorer, (repository_root / AXE).read_text()) == []


@pytest.mark.parametrize(
    ("tab", "shown"),
    [
        ("device", "#device-fields input"),
        ("regions", "#disks .disk"),
        ("follows", "#path .step"),
        ("network", "#network .way .ring-in"),
        ("locate", "#locate-form select"),
        ("poses", "#poses-text"),
        ("threads", "#compared table"),
    ],
)
def test_axe_finds_nothing_serious_in_a_tab(explorer: Explorer, repository_root: Path, tab: str, shown: str) -> None:
    panel = f"[aria-labelledby=tab-{tab}]"
    explorer.click(f"#tab-{tab}")
    explorer.one(f"{panel} {shown}")
    for theme in THEMES:
        explorer.choose("#theme", theme)
        assert violations(explorer, (repository_root / AXE).read_text(), panel, least_passes=4) == []


def test_axe_finds_nothing_serious_about_the_path_of_a_held_bolt(explorer: Explorer, repository_root: Path) -> None:
    explorer.open(f"/#{COMPUTED}")
    explorer.one("#turned-chart .curve")
    for theme in THEMES:
        explorer.choose("#theme", theme)
        for panel in ("#panel-device", ".panel.turned"):
            assert violations(explorer, (repository_root / AXE).read_text(), panel, least_passes=4) == []


@pytest.mark.parametrize("path", ["/nowhere", "licences"])
def test_axe_finds_nothing_serious_on_plain_pages(explorer: Explorer, repository_root: Path, path: str) -> None:
    links = explorer.run("return [...document.querySelectorAll('nav a')].map((link) => link.getAttribute('href'))")
    (address,) = [link for link in [*links, "/nowhere"] if path in link]
    explorer.open(address)
    explorer.one("main h2")
    explorer.complaints()
    assert violations(explorer, (repository_root / AXE).read_text()) == []
