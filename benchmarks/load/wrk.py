"""wrk: requests for random addresses of a pattern, over some connections, for some seconds."""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

CONNECTIONS = 16
"""Of one thread: wrk has one of two cores beside the server."""

_SCRIPT = """
math.randomseed(%(seed)d)
local path = %(path)s
local ranges = { %(ranges)s }
local headers = { %(headers)s }
request = function()
  local values = {}
  for i, range in ipairs(ranges) do values[i] = math.random(range[1], range[2]) end
  return wrk.format("GET", string.format(path, unpack(values)), headers)
end
done = function(summary, latency, requests)
  local errors = summary.errors
  local broken = errors.connect + errors.read + errors.write + errors.timeout
  local p50, p99 = latency:percentile(50), latency:percentile(99)
  local found = { summary.requests, summary.duration, summary.bytes, p50, p99, errors.status, broken }
  io.write("\\n[" .. table.concat(found, ", ") .. "]\\n")
end
"""


class LoadError(Exception):
    """A load test without a result: a server refused or broke off, or wrk is not installed."""


@dataclass(frozen=True)
class RequestPattern:
    """Requests of one kind: a pattern of an address, the range of each whole number in it, and headers."""

    path: str
    ranges: tuple[tuple[int, int], ...] = ()
    headers: tuple[tuple[str, str], ...] = ()

    def first(self) -> str:
        """One of the addresses."""
        return self.path % tuple(low for low, _ in self.ranges)


@dataclass(frozen=True)
class LoadResult:
    """Responses a second, percentiles of the response time in milliseconds, kilobytes of a response."""

    rate: float
    p50_ms: float
    p99_ms: float
    kilobytes: float


def load(address: str, pattern: RequestPattern, seconds: float, seed: int) -> LoadResult:
    """Load a server with as many requests as it can answer.

    Raises:
        LoadError: an answer was none (4xx, 5xx, a connection that broke), or there is no wrk.
    """
    wrk = shutil.which("wrk")
    if wrk is None:
        raise LoadError("wrk is not installed: apt-get install wrk")
    script = _SCRIPT % {
        "seed": seed,
        "path": json.dumps(pattern.path),
        "ranges": ", ".join(f"{{{low}, {high}}}" for low, high in pattern.ranges),
        "headers": ", ".join(f"[{json.dumps(name)}] = {json.dumps(value)}" for name, value in pattern.headers),
    }
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "request.lua"
        path.write_text(script)
        command = [wrk, "-t1", f"-c{CONNECTIONS}", f"-d{seconds:g}s", "--timeout", "30s", "-s", str(path), address]
        said = subprocess.run(command, check=False, capture_output=True, text=True)
    if said.returncode:
        raise LoadError(said.stderr.strip() or said.stdout.strip())
    requests, microseconds, received, p50, p99, refused, broken = json.loads(said.stdout.strip().splitlines()[-1])
    if refused or broken or not requests:
        raise LoadError(f"{pattern.path}: of {requests} requests {refused} were refused, and {broken} broken off")
    return LoadResult(requests / (microseconds * 1e-6), p50 * 1e-3, p99 * 1e-3, received / requests * 1e-3)
