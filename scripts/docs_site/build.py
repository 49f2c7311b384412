"""Builds the site in a temporary folder, from where it is moved to its own once it is whole."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from scripts.docs_site.staging import stage

HERE = Path(__file__).parent
CONFIGURATION, STYLES, WORKER = "mkdocs.yml", "site.css", "frame_worker.js"
REMOTE_WORKER = re.compile(r'<script src="https?://[^"]*/iframe-worker/[^"]*"[^>]*></script>')
"""What the generator would have a browser fetch from elsewhere, so that it can search from files."""
REMOTE = re.compile(r"https?://(?!www\.w3\.org/)[\w.-]+/[^\s\"'`$]*")
"""Addresses in the theme's scripts, of what its pages can load besides: editors, diagrams, counts of stars."""
CELL = re.compile(r"<td>(?P<content>.*?)</td>", re.DOTALL)
NAME = re.compile(r"<code>([^<\n]{1,24})</code>")
"""Code that is short enough to stay on one line."""
SHORT, LONG = 14, 60
"""Characters up to which a table's cell stays on one line, and from which on it is a text that wants some width."""


class SiteError(Exception):
    """The site cannot be built: what its generator said."""


def build_site(root: Path, folder: Path) -> None:
    """Build the site of the repository at ``root`` into ``folder``, which is replaced.

    Raises:
        SiteError: a link or an anchor is broken, or the generator failed otherwise.
        FileNotFoundError: a page links to a file that is not there.
    """
    with tempfile.TemporaryDirectory(prefix="threadstate-site-") as name:
        project = Path(name).resolve()
        navigation = stage(root, project / "docs")
        shutil.copy(HERE / STYLES, project / "docs" / STYLES)
        # JSON is YAML.
        configuration = f"{(HERE / CONFIGURATION).read_text()}\nnav: {json.dumps(navigation)}\n"
        (project / CONFIGURATION).write_text(configuration)
        command = [sys.executable, "-m", "zensical", "build", "--strict", "--config-file", CONFIGURATION]
        run = subprocess.run(command, cwd=project, check=False, capture_output=True, text=True)
        if run.returncode != 0:
            raise SiteError((run.stdout + run.stderr).partition("Traceback")[0])
        _finish(project / "site")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.move(project / "site", folder)


def _finish(site: Path) -> None:
    """Have the pages load nothing from elsewhere, and mark what is styled by its length."""
    shutil.copy(HERE / WORKER, site / WORKER)
    for path in site.rglob("*.html"):
        script = f'<script src="{os.path.relpath(site / WORKER, path.parent)}"></script>'
        local = REMOTE_WORKER.sub(script, path.read_text())
        path.write_text(CELL.sub(_marked, NAME.sub(r'<code class="name">\1</code>', local)))
    for path in (site / "assets").rglob("*.js"):
        path.write_text(REMOTE.sub("about:blank", path.read_text()))


def _marked(cell: re.Match[str]) -> str:
    """A cell of a table, with a class if its text is short or long."""
    length = len(re.sub(r"<[^>]*>", "", cell["content"]))
    kind = "short" if length <= SHORT else "long" if length > LONG else None
    return f'<td class="{kind}">{cell["content"]}</td>' if kind else cell[0]
