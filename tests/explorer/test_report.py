"""The page of a report in a browser: it fits a phone, and neither asks for anything nor complains."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium import webdriver

from harness.browser import resize
from tests.report.example import example_report
from threadstate.report.page import report_page

pytestmark = pytest.mark.slow

HOSTILE = "<script>document.title = 'run'</script>" + "W" * 200
BOXES = " && !one.closest('.scroll, pre')"
"""What is in a box that scrolls may be wider than the window; on paper nothing scrolls."""
WIDER = f"""
const wide = (one) => one.getBoundingClientRect().right > innerWidth + 0.5{BOXES};
return [...document.querySelectorAll('main *')].filter(wide).map((one) => one.outerHTML.slice(0, 80));
"""
MM_PER_POINT = 25.4 / 72.0
PRINTED_PX = 680
"""The width of A4 without margins, 180 mm."""


@pytest.fixture
def opened(chromium: webdriver.Chrome, tmp_path: Path) -> Iterator[webdriver.Chrome]:
    """The browser with the page of a made-up map and a title that a page does not expect."""
    path = tmp_path / "report.html"
    path.write_text(report_page(example_report(title=HOSTILE)), encoding="utf-8")
    chromium.get("about:blank")
    chromium.get_log("browser")
    chromium.get_log("performance")
    chromium.get(path.as_uri())
    yield chromium
    resize(chromium, 1280, 800)
    chromium.get("about:blank")


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_is_wider_than_the_window(opened: webdriver.Chrome, width: int) -> None:
    resize(opened, width, 800)
    assert opened.execute_script("return document.scrollingElement.scrollWidth <= innerWidth")
    assert opened.execute_script(WIDER) == []
    assert opened.title == HOSTILE


def test_nothing_is_asked_for_and_nothing_complained_of(opened: webdriver.Chrome) -> None:
    opened.execute_script("scrollTo(0, document.scrollingElement.scrollHeight)")
    assert opened.get_log("browser") == []
    asked = [
        message["params"]["request"]["url"]
        for message in (json.loads(entry["message"])["message"] for entry in opened.get_log("performance"))
        if message["method"] == "Network.requestWillBeSent"
    ]
    assert len([url for url in asked if url.startswith("file:")]) == 1
    assert all(url.startswith(("file:", "data:")) for url in asked)


def test_it_is_dark_where_the_reader_is_and_black_on_white_on_paper(opened: webdriver.Chrome) -> None:
    def colours(**media: object) -> tuple[str, str]:
        opened.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
        script = "const style = getComputedStyle(document.body); return [style.backgroundColor, style.color]"
        ground, ink = opened.execute_script(script)
        return ground, ink

    dark = [{"name": "prefers-color-scheme", "value": "dark"}]
    try:
        assert colours(features=[{"name": "prefers-color-scheme", "value": "light"}])[0] == "rgb(255, 255, 255)"
        assert colours(features=dark)[0] == "rgb(23, 27, 32)"
        assert colours(media="print", features=dark) == ("rgb(255, 255, 255)", "rgb(0, 0, 0)")
    finally:
        colours(media="", features=[])


def test_it_is_printed_on_a4_and_nothing_is_cut_off(opened: webdriver.Chrome) -> None:
    printed = opened.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", base64.b64decode(printed["data"]))
    assert len(boxes) >= 3
    for width, height in boxes:
        assert float(width) == pytest.approx(210.0 / MM_PER_POINT, abs=1.0)
        assert float(height) == pytest.approx(297.0 / MM_PER_POINT, abs=1.0)
    resize(opened, PRINTED_PX, 1000)
    opened.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        assert opened.execute_script(WIDER.replace(BOXES, "")) == []
    finally:
        opened.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
