from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.worker.conftest import CommandLine
from threadstate.library.engine import writing
from worker.migrate import migrate
from worker.serving import UnusableAddressError, address, check_address


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


@pytest.fixture
def taken_port() -> Iterator[int]:
    """A port of this machine that is listened on."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield listening.getsockname()[1]


def test_a_port_that_is_taken_is_found_before_anything_is_announced(command_line: CommandLine, taken_port: int) -> None:
    with writing(command_line.database) as engine:
        migrate(engine)
    code, out, err = command_line.here("serve", "--port", str(taken_port))
    assert (code, out) == (1, "")
    assert f"port {taken_port} of 127.0.0.1 is taken by another process; --port" in err
    assert "Open http" not in err
    assert len(err.splitlines()) == 1


@pytest.mark.sqlite_alone
def test_a_port_that_is_taken_is_found_before_a_library_is_computed(command_line: CommandLine, taken_port: int) -> None:
    code, _, err = command_line.here("run", "--port", str(taken_port))
    assert code == 1
    assert f"port {taken_port}" in err
    assert not Path(command_line.database.removeprefix("sqlite:///")).exists()


def test_an_address_of_another_machine_is_refused() -> None:
    with pytest.raises(UnusableAddressError, match=r"cannot listen on 192\.0\.2\.1, port 8000 .*--host"):
        check_address("192.0.2.1", 8000)


def test_a_socket_that_is_passed_on_is_not_looked_for(taken_port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LISTEN_PID", str(os.getpid()))
    check_address("127.0.0.1", taken_port)
