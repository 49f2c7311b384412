"""The service as a process of its own."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager


@contextmanager
def running_service(database: str, port: int = 0, settings: Mapping[str, str] | None = None) -> Iterator[str]:
    """The address of a running service over a database, at that port or (0) at a free one, with these settings more."""
    command = [sys.executable, "-m", "uvicorn", "--factory", "service.app:create_app", "--port", str(port)]
    environment = {**os.environ, "THREADSTATE_DATABASE": database, **(settings or {})}
    # Read to its end only after it was stopped: without the log of requests little is written.
    with subprocess.Popen([*command, "--no-access-log"], env=environment, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        try:
            for line in process.stderr:
                if found := re.search(r"running on (http://\S+)", line):
                    yield found[1]
                    break
            else:
                raise AssertionError("the service did not start")
        finally:
            process.terminate()
