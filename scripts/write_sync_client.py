"""``make client``: makes the blocking client, threadstate/client/_sync, of the asynchronous one beside it."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from unasync import Rule, unasync_files

ROOT = Path(__file__).parent.parent
ASYNC = ROOT / "threadstate" / "client" / "_async"
SYNC = ASYNC.with_name("_sync")

NAMES = {
    "AsyncClient": "Client",
    "AsyncTransport": "Transport",
    "AsyncItems": "Items",
    "AsyncItems[{}]": "Items[{}]",
    "AsyncJob": "Job",
    "_async": "_sync",
    "aclose": "close",
    "aiter_bytes": "iter_bytes",
    "aread": "read",
    "async_pause": "pause",
    "async_write": "write",
}
"""Names and whole strings, beside those that unasync knows."""

PHRASES = {
    r"(?:Awaitable|Coroutine)\[(?:Any, Any, )?(\w+)\]": r"\1",
    "The asynchronous client; .* of these files": "The blocking client, made of ``_async`` by ``make client``",
    "The client for asynchronous programs": "The client that waits for its responses",
    "An asynchronous client": "A client",
    r"several tasks of one event loop \(asyncio or trio\)": "several threads",
    "several tasks": "several threads",
}
"""Regular expressions for what is more than a name."""

HEADER = "# Made of _async/{} by `make client`: edit that one.\n"


def generated() -> Mapping[str, str]:
    """The blocking client's files by name."""
    with TemporaryDirectory() as folder:
        sources = Path(folder) / "_async"
        sources.mkdir()
        for path in ASYNC.glob("*.py"):
            text = path.read_text()
            for phrase, replacement in PHRASES.items():
                text = re.sub(phrase, replacement, text)
            (sources / path.name).write_text(text)
        unasync_files([str(path) for path in sources.glob("*.py")], [Rule("/_async/", "/_sync/", NAMES)])
        made = {path.name: path.read_text() for path in sources.with_name("_sync").glob("*.py")}
    return {name: _tidied(HEADER.format(name) + text, SYNC / name) for name, text in made.items()}


def _tidied(text: str, path: Path) -> str:
    """A file as the linter and the formatter want it; imports that serve wait alone are dropped."""
    for command in (["check", "--select", "F401,I", "--fix", "--quiet"], ["format", "--quiet"]):
        run = [sys.executable, "-m", "ruff", *command, "--stdin-filename", str(path), "-"]
        text = subprocess.run(run, cwd=ROOT, input=text, check=True, capture_output=True, text=True).stdout
    return text


def main() -> None:
    """Write the files."""
    for name, text in generated().items():
        (SYNC / name).write_text(text)


if __name__ == "__main__":
    main()
