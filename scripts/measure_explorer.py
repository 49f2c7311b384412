"""Prints how long the explorer takes to be seen and to follow the phase (``python -m scripts.measure_explorer``).

The service runs over the database of the settings, warm: a load before the first that counts. From the start of the
navigation to the paint of the map, the depth, the numbers and the solids, with an empty and a full browser cache; what
was fetched, and how long a frame takes while the phase moves, with the solids and without. Last a success map of the
default device: from the click to its first square, and to all of them, without friction and with it.
"""

from __future__ import annotations

from statistics import median
from time import monotonic, sleep
from typing import Any
from urllib.request import urlopen

from harness.browser import Explorer, resize, start_chromium
from harness.running_service import running_service
from threadstate.settings import read_settings

LOADS = 7
FRAMES = 120
MAPS = (("", "1"), ("0.2", "1"), ("0.2", "12"))
"""Frictions and starting phases of the maps, as the form takes them."""
TIMEOUT_S = 300.0
VIEW = "/#roll=0&pitch=-4&phase=10"
SEEN = ("map", "depth", "state", "solids")
MARKED = "return performance.getEntriesByType('mark').map((one) => one.name)"
TIMES = """
const fetched = performance.getEntriesByType('resource');
const times = Object.fromEntries(performance.getEntriesByType('mark').map((one) => [one.name, one.startTime]));
const bytes = fetched.reduce((sum, one) => sum + one.transferSize, 0);
return { times, files: fetched.length, bytes };
"""
SCRUB = """
const [frames, done] = arguments;
const slider = document.querySelector('#phase-slider');
const took = [];
const work = [];
let before = performance.now();
const next = (now) => {
  took.push(now - before);
  before = now;
  if (took.length > frames) {
    done({ took: took.slice(1), work, requests: performance.getEntriesByType('resource').length });
    return;
  }
  const begun = performance.now();
  slider.value = (took.length * 3) % 360;
  slider.dispatchEvent(new Event('input', { bubbles: true }));
  work.push(performance.now() - begun);
  requestAnimationFrame(next);
};
performance.clearResourceTimings();
requestAnimationFrame(next);
"""
FILLED = "return document.querySelectorAll('#success .cell rect:first-child:not(.none)').length"
LOOK_S = 0.02
MAP_TIMEOUT_S = 600.0


def main() -> None:
    """Print all figures."""
    chromium = start_chromium(1280, 800)
    chromium.set_script_timeout(TIMEOUT_S)
    try:
        with running_service(read_settings().database) as address:
            explorer = Explorer(chromium, address)
            _warm(address)
            _loaded(explorer)
            for cache in ("empty", "full"):
                chromium.execute_cdp_cmd("Network.setCacheDisabled", {"cacheDisabled": cache == "empty"})
                _print_loads(cache, [_loaded(explorer) for _ in range(LOADS)])
            _print_frames("with the solids", _scrubbed(explorer))
            resize(chromium, 1280, 800)
            explorer.choose("#nut-look", "off")
            explorer.run("document.querySelector('.panel.scene').hidden = true")
            _print_frames("without the solids", _scrubbed(explorer))
            for mu, phases in MAPS:
                _print_map(explorer, mu, phases)
    finally:
        chromium.quit()


def _warm(address: str) -> None:
    """Have the service load what its first answers need: it starts without its solver."""
    for path in ("histories/0/-4/heights", "meshes/bolt", "meshes/nut"):
        with urlopen(f"{address}/v1/libraries/latest/{path}", timeout=TIMEOUT_S) as answer:
            answer.read()


def _loaded(explorer: Explorer) -> dict[str, Any]:
    explorer.open(VIEW)
    explorer.wait(lambda: {f"painted {name}" for name in SEEN} <= set(explorer.run(MARKED)), "not all is painted")
    times: dict[str, Any] = explorer.run(TIMES)
    return times


def _print_loads(cache: str, loads: list[dict[str, Any]]) -> None:
    for name in SEEN:
        times = sorted(load["times"][f"painted {name}"] for load in loads)
        print(
            f"{cache} cache: {name} painted after {times[0]:.0f} to {times[-1]:.0f} ms, median {median(times):.0f} ms"
        )
    print(f"{cache} cache: {loads[-1]['files']} files, {loads[-1]['bytes'] / 1000:.0f} kB over the wire")


def _scrubbed(explorer: Explorer) -> dict[str, Any]:
    found: dict[str, Any] = explorer.chromium.execute_async_script(SCRUB, FRAMES)
    return found


def _print_frames(what: str, found: dict[str, Any]) -> None:
    took, work = sorted(found["took"]), sorted(found["work"])
    late = took[int(0.95 * len(took))]
    print(
        f"phase moved in every frame, {what}: {median(took):.1f} ms a frame, {late:.1f} ms at the 95th percentile; "
        f"{median(work):.1f} ms of them the page's own; {found['requests']} requests"
    )


def _print_map(explorer: Explorer, mu: str, phases: str) -> None:
    explorer.open(f"{VIEW}&tab=success")
    explorer.wait(lambda: explorer.one("#success-compute").is_displayed(), "the tab is not shown")
    friction = explorer.one("#success-mu")
    friction.clear()
    friction.send_keys(mu)
    explorer.choose("#success-phases", phases)
    explorer.click("#success-compute")
    begun = monotonic()
    first = None
    while (took := monotonic() - begun) < MAP_TIMEOUT_S:
        count = explorer.run(FILLED)
        if first is None and count > 0:
            first = took
        if first is not None and not explorer.one("#success-cancel").is_enabled():
            break
        sleep(LOOK_S)
    print(
        f"success map, mu {mu or '0'}, {phases} starting phases: first square after {first or took:.2f} s, "
        f"{count} after {took:.1f} s {explorer.text('#success-problem')}"
    )


if __name__ == "__main__":
    main()
