from __future__ import annotations

import pytest

from worker.serving import address


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", "http://127.0.0.1:8000"),
        ("0.0.0.0", "http://127.0.0.1:8000"),
        ("::", "http://[::1]:8000"),
        ("threads.example", "http://threads.example:8000"),
    ],
)
def test_the_address_can_be_opened_on_this_machine(host: str, expected: str) -> None:
    assert address(host, 8000) == expected
