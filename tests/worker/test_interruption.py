"""A worker that is told to stop does what it has begun, and waits no more."""

from __future__ import annotations

import signal
import time
from pathlib import Path

import pytest
from sqlalchemy import event, text

from threadstate.library.engine import writing
from worker.interruption import interruptible_at_waits, waiting

NUMBERS = (signal.SIGTERM, signal.SIGINT)


@pytest.mark.parametrize("number", NUMBERS)
def test_a_wait_ends_at_once(number: signal.Signals) -> None:
    with interruptible_at_waits():
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt), waiting():
            signal.raise_signal(number)
            time.sleep(60.0)
    assert time.monotonic() - start < 30.0


@pytest.mark.parametrize("number", NUMBERS)
def test_a_transaction_is_whole_and_the_next_wait_does_not_begin(number: signal.Signals, tmp_path: Path) -> None:
    with interruptible_at_waits(), writing(f"sqlite:///{tmp_path / 'one.db'}") as engine:

        @event.listens_for(engine, "commit")
        def tell(_connection: object) -> None:
            signal.raise_signal(number)

        with engine.begin() as connection:
            connection.execute(text("CREATE TABLE t (a INTEGER)"))
        event.remove(engine, "commit", tell)
        with engine.begin() as connection:
            assert connection.execute(text("SELECT count(*) FROM t")).scalar_one() == 0
        began = False
        with pytest.raises(KeyboardInterrupt), waiting():
            began = True
        assert not began


def test_outside_of_it_signals_are_as_before_and_waits_are_waits() -> None:
    before = [signal.getsignal(number) for number in NUMBERS]
    with interruptible_at_waits():
        signal.raise_signal(signal.SIGTERM)
    assert [signal.getsignal(number) for number in NUMBERS] == before
    with interruptible_at_waits(), waiting():
        pass
