"""The blocking client is what ``make client`` makes of the asynchronous one."""

from __future__ import annotations

import re

from scripts.write_sync_client import ASYNC, PHRASES, SYNC, generated


def test_the_committed_files_are_those_that_are_generated() -> None:
    assert {path.name: path.read_text() for path in SYNC.glob("*.py")} == generated()


def test_nothing_of_it_waits() -> None:
    words = re.compile(r"async|await|anyio|task|loop", re.IGNORECASE)
    for text in generated().values():
        body = text.split("\n", 2)[2]
        assert words.findall(body) == []


def test_every_phrase_is_still_said() -> None:
    said = "".join(path.read_text() for path in ASYNC.glob("*.py"))
    assert [phrase for phrase in PHRASES if not re.search(phrase, said)] == []
