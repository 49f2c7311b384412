"""A headless Chromium that looks at one service, and what it noticed."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from selenium import webdriver
from selenium.common.exceptions import ElementNotInteractableException, StaleElementReferenceException, TimeoutException
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.ui import WebDriverWait

ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--no-first-run",
    "--enable-unsafe-swiftshader",
    "--force-color-profile=srgb",
    # Pages that were left would be held ready for Back, each with its solids, in a process of its own.
    "--disable-features=BackForwardCache",
)
WAIT_S = 20.0
SCRIPT_S = 120.0
"""axe-core looks at every element of the page, without a graphics card."""


def start_chromium(width: int, height: int, *more_arguments: str) -> webdriver.Chrome:
    """A Chromium with a viewport of that size."""
    driver = shutil.which("chromedriver")
    assert driver, "chromedriver is missing; on Debian: apt-get install chromium chromium-driver"
    options = webdriver.ChromeOptions()
    for argument in (*ARGUMENTS, *more_arguments):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    chromium = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    chromium.set_script_timeout(SCRIPT_S)
    resize(chromium, width, height)
    return chromium


def resize(chromium: webdriver.Chrome, width: int, height: int) -> None:
    """Give the viewport that size in pixels."""
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    chromium.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)


RESET = """
const shown = document.querySelector('#explorer:not([hidden])');
const isOfOneFormation = document.querySelector('#follows .card, #path .step, #network .formation') !== null;
if (location.origin !== arguments[0] || !shown || !window.opened || isOfOneFormation) return false;
for (const one of document.querySelectorAll('#play-stages, #play-phase')) {
  if (one.getAttribute('aria-pressed') === 'true') one.click();
}
document.querySelector('#axes').close();
document.querySelector('#toast').textContent = '';
document.activeElement.blur();
history.pushState(null, '', window.opened.view);
dispatchEvent(new PopStateEvent('popstate'));
return true;
"""
"""Sets the view that the page was opened with, as Back does; whether the page is one that can.

What follows a formation stays as it is until its tab is opened again: a page that has shown it is loaded again.
"""
SHOWN = (
    "['#state', '#depth', '#map', '#map-readout', '#map-phase'].map((one) => document.querySelector(one).textContent)"
)
REMEMBER = f"window.opened = {{view: location.hash, shown: {SHOWN}.join()}}"
IS_RESET = f"return location.hash === window.opened.view && {SHOWN}.join() === window.opened.shown"

AIM = """
const [element, selector] = arguments;
element.scrollIntoView({block: 'center'});
window.isHit = false;
const hear = ({target}) => (window.isHit = target.closest(selector) !== null);
addEventListener('click', hear, {capture: true, once: true});
"""
"""Brings an element into view; `isHit`: a click has reached one of that selector; undefined on another page."""


class Explorer:
    """The explorer's page in a browser."""

    def __init__(self, chromium: webdriver.Chrome, address: str) -> None:
        self.chromium = chromium
        self.address = address

    def open(self, path: str = "/") -> None:
        """Reload the page at that path or fragment."""
        self.chromium.get("about:blank")
        self.chromium.get(self.address + path)

    def reset(self) -> None:
        """Bring the explorer to the view that it opens with; load it only where no page is open that can be reset."""
        self.chromium.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": 0, "y": 0})
        if not self.run(RESET, self.address):
            self.open()
            self.wait_for_text("#state", "roll")
            self.wait_for_text("#depth", "snap: falls")
            self.wait_for_text("#map-phase", "at phase")
            self.run(REMEMBER)
        self.wait(lambda: bool(self.run(IS_RESET)), "the page does not show the view that it was opened with")

    def run(self, script: str, *arguments: object) -> Any:
        """What a script returns."""
        return self.chromium.execute_script(script, *arguments)

    def fetched(self, path: str) -> Any:
        """The JSON that the page's own fetch gets at a path."""
        return self.chromium.execute_async_script(
            "const [path, done] = arguments; fetch(path).then((answer) => answer.json()).then(done)", path
        )

    def received(self, path: str) -> Any:
        """The JSON that the page itself was sent from a path, since requests were last read."""
        messages = [json.loads(entry["message"])["message"] for entry in self.chromium.get_log("performance")]
        ended = {one["params"]["requestId"] for one in messages if one["method"] == "Network.loadingFinished"}
        (request,) = (
            one["params"]["requestId"]
            for one in messages
            if one["method"] == "Network.requestWillBeSent"
            and one["params"]["request"]["url"] == self.address + path
            and one["params"]["requestId"] in ended
        )
        return json.loads(self.chromium.execute_cdp_cmd("Network.getResponseBody", {"requestId": request})["body"])

    def one(self, selector: str) -> WebElement:
        """The element that a selector names, when it is there."""
        self.wait(lambda: bool(self.chromium.find_elements(By.CSS_SELECTOR, selector)), f"no {selector}")
        return self.chromium.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector: str) -> list[WebElement]:
        """The elements that a selector names now."""
        return self.chromium.find_elements(By.CSS_SELECTOR, selector)

    def click(self, selector: str) -> None:
        """Bring an element into view and click it; again if the page just replaced or moved it."""
        self.wait(lambda: self._is_clicked(selector), f"{selector} is replaced or moved again and again")

    def _is_clicked(self, selector: str) -> bool:
        element = self.one(selector)
        try:
            self.run(AIM, element, selector)
            element.click()
        except StaleElementReferenceException:
            return False
        return self.run("return window.isHit") is not False

    def press(self, selector: str, key: str) -> None:
        """Press a key at an element, as soon as the page shows one of that selector that can have the focus."""

        def is_pressed() -> bool:
            try:
                self.one(selector).send_keys(key)
            except (ElementNotInteractableException, StaleElementReferenceException):
                return False
            return True

        self.wait(is_pressed, f"{selector} takes no key")

    def text(self, selector: str) -> str:
        """The text of an element."""
        return str(self.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector))

    def wait(self, happened: Callable[[], bool], message: str) -> None:
        """Wait until something has happened."""
        try:
            WebDriverWait(self.chromium, WAIT_S, poll_frequency=0.03).until(lambda _: happened())
        except TimeoutException:
            raise AssertionError(message) from None

    def wait_for_text(self, selector: str, text: str) -> None:
        """Wait until an element's text holds ``text``."""
        self.wait(lambda: text in self.text(selector), f"{selector} does not say {text!r}")

    def choose(self, selector: str, value: str) -> None:
        """Set a control as its user does: with an event that bubbles."""
        self.one(selector)
        self.run(
            "const [selector, value] = arguments; const control = document.querySelector(selector);"
            "control.value = value; control.dispatchEvent(new Event('input', {bubbles: true}));"
            "control.dispatchEvent(new Event('change', {bubbles: true}))",
            selector,
            value,
        )

    def complaints(self) -> list[str]:
        """All that the console holds since it was last read: errors, warnings, policy violations.

        What the graphics driver says of its pace is no complaint of the page.
        """
        entries = self.chromium.get_log("browser")
        return [f"{one['level']}: {one['message']}" for one in entries if one["source"] != "rendering"]

    def addresses_asked(self) -> list[str]:
        """The addresses of all requests since they were last read."""
        messages = [json.loads(entry["message"])["message"] for entry in self.chromium.get_log("performance")]
        return [one["params"]["request"]["url"] for one in messages if one["method"] == "Network.requestWillBeSent"]


def hosts_of(addresses: list[str]) -> set[str]:
    """The hosts of addresses that lead out of the page."""
    return {urlsplit(url).netloc for url in addresses if urlsplit(url).scheme not in ("data", "blob", "about")}


def phase_of(explorer: Explorer) -> float:
    """The phase in degrees that the page is at."""
    return float(explorer.run("return document.querySelector('#phase').value"))
