"""Takes the pictures of the explorer, docs/explorer/*.png, from the running page (``make screenshots``).

The service runs over the database of the settings, whose latest library has to be that of the default grid.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import sleep

from selenium import webdriver

from harness.browser import Explorer, resize, start_chromium
from harness.running_service import running_service
from threadstate.settings import read_settings

FOLDER = Path(__file__).parent.parent / "docs" / "explorer"
LAPTOP, DESKTOP = (1280, 800), (1920, 1080)
REST_S = 1.0
DRAWN = ("#map .cell", "#depth .curve", "#scene canvas")


@dataclass(frozen=True)
class Shot:
    """A picture: its file's name, the size of the page in pixels, the view as a fragment, what its tab shows.

    What is computed for it may take ``waits`` times as long as a browser test waits.
    """

    name: str
    size: tuple[int, int]
    view: str
    tab: str
    waits: int = 1


SHOTS = (
    Shot("laptop-light", LAPTOP, "roll=0&pitch=-4&phase=10&theme=light", "#state table"),
    Shot("laptop-dark", LAPTOP, "roll=-4&pitch=0&phase=131&theme=dark&quantity=drop&tab=regions", "#disks .disk"),
    Shot("laptop-follows", LAPTOP, "roll=2&pitch=-3&phase=200&theme=light&nut=glass&tab=follows", "#path .step"),
    Shot("laptop-any-tilt", LAPTOP, "roll=2.5&pitch=-1.2&phase=357&theme=light&tolerance=0.3", "#falls:not(:empty)"),
    Shot(
        "laptop-beside",
        LAPTOP,
        "roll=-4&pitch=-4&phase=300&theme=dark&beside_library=1&beside_roll=0&beside_pitch=-4&tab=poses"
        "&poses=-4,-4,300;-4,-4,352.5;2.5,-1.2,357",
        "#poses-list tbody tr",
    ),
    Shot(
        "laptop-load",
        LAPTOP,
        "roll=2&pitch=0&phase=345&theme=light&nut=glass&tab=load&mu=0.3&fx=0.1&quantity=mu_hold",
        "#jamming .edge",
    ),
    Shot(
        "laptop-device",
        LAPTOP,
        "roll=0&pitch=-4&phase=300&theme=light&nut=glass&tab=device&point=100"
        "&assembly=roll%3D0%26pitch%3D-4%26phase%3D300%26unit%3Dmm",
        "#turned-chart svg",
    ),
    Shot(
        "laptop-success",
        LAPTOP,
        "roll=0&pitch=-4&phase=300&theme=light&nut=glass&tab=success&success=phases%3D2%26roll%3D0%26pitch%3D-4"
        "%26phase%3D300%26strategy%3Dccw_then_cw%26unit%3Dmm",
        "#panel-success:has(#success-progress[hidden]) #success .cell",
        waits=60,
    ),
    Shot("laptop-threads", LAPTOP, "theme=light&tab=threads&thread=M6+at+minimum+material", "#profiles img + img"),
    Shot("laptop-network", LAPTOP, "roll=-3&pitch=3&phase=120&theme=light&tab=network", "#network .way .stop"),
    Shot(
        "desktop-light",
        DESKTOP,
        "roll=0&pitch=-4&phase=50&theme=light&quantity=snap&from=-16&span=96&tab=regions",
        "#disks .disk",
    ),
    Shot(
        "desktop-dark",
        DESKTOP,
        "roll=1&pitch=-2&phase=10&theme=dark&quantity=pivot_offset&over=all&stage=2&tab=network",
        "#network .way .ring-in",
    ),
)


def main() -> None:
    """Take all pictures."""
    FOLDER.mkdir(exist_ok=True)
    chromium = start_chromium(*LAPTOP)
    try:
        with running_service(read_settings().database) as address:
            explorer = Explorer(chromium, address)
            for shot in SHOTS:
                _take(explorer, chromium, shot)
    finally:
        chromium.quit()


def _take(explorer: Explorer, chromium: webdriver.Chrome, shot: Shot) -> None:
    resize(chromium, *shot.size)
    explorer.open(f"/#{shot.view}")
    for selector in DRAWN:
        explorer.one(selector)
    for _ in range(shot.waits - 1):
        with suppress(AssertionError):
            explorer.one(shot.tab)
            break
    explorer.one(shot.tab)
    label = "return document.querySelector('#scene canvas').getAttribute('aria-label') ?? ''"
    explorer.wait(lambda: "phase" in explorer.run(label), "the scene is not drawn")
    # Without a graphics card a change of the solids is drawn after a rest.
    looks = [chromium.get_screenshot_as_png()]

    def is_settled() -> bool:
        sleep(REST_S)
        looks.append(chromium.get_screenshot_as_png())
        return looks[-1] == looks[-2]

    explorer.wait(is_settled, "the page goes on changing")
    path = FOLDER / f"{shot.name}.png"
    path.write_bytes(looks[-1])
    print(f"{path.relative_to(FOLDER.parent.parent)}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
