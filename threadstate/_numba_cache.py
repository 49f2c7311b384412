"""The cache directory of compiled kernels: chosen before numba is imported; a failure never breaks an import.

The directory is the first of these that can be written to:

1. ``THREADSTATE_NUMBA_CACHE_DIR``, if set;
2. ``threadstate/numba`` under the user's cache directory (``XDG_CACHE_HOME``, else ``~/.cache``);
3. a directory of this user's own under the system's directory for temporary files;
4. a fresh temporary directory (kernels are then compiled again in every process).

Inside it, the sources of all kernels choose a subdirectory by their hash: numba compares a kernel's own file alone, so
without that a kernel compiled against an older version of one that it calls would still be used.
A ``NUMBA_CACHE_DIR`` that the user has set himself is left as it is, unless ``THREADSTATE_NUMBA_CACHE_DIR`` is set.

A subdirectory that no process has used for ``UNUSED_DAYS`` is removed. A process holds a shared lock on the file
``used`` of its own while it lives, and a process that removes one needs the exclusive lock.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

UNUSED_DAYS = 30.0
LOOK_DAYS = 1.0
"""How long a subdirectory is kept after its last use, and how often the last use is recorded and others are checked."""
SETTING = "THREADSTATE_NUMBA_CACHE_DIR"
_NUMBA_SETTING = "NUMBA_CACHE_DIR"
_MARKS = (b"njit", b"@kernel", b"numba.core")
"""What the source of a kernel holds, and of how it is compiled."""
_VERSION_DIGITS = 16
_MARKER = "used"
_DAY_S = 86400.0
_held: list[int] = []
"""The descriptor of the open marker of the directory that this process uses: with it the lock ends."""


def choose_numba_cache() -> None:
    """Set numba's cache directory for this process and those it starts; does not import numba."""
    inherited = os.environ.get(_NUMBA_SETTING)
    if inherited and not os.environ.get(SETTING):
        if (Path(inherited) / _MARKER).is_file():  # chosen by a process that started this one, and may end before it
            _use(Path(inherited))
        return
    version = kernel_sources_hash(Path(__file__).parent)[:_VERSION_DIGITS]
    directory = next((path for path in _candidates(version) if _can_write(path)), None)
    if directory is not None:
        _use(directory)
    os.environ[_NUMBA_SETTING] = str(directory or tempfile.mkdtemp(prefix="threadstate-numba-"))
    if "numba" in sys.modules:
        sys.modules["numba"].config.reload_config()


def kernel_sources_hash(package: Path) -> str:
    """SHA-256, in hexadecimal, of the names and bytes of all files under ``package`` that hold numba kernels."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if any(mark in source for mark in _MARKS):
            digest.update(f"{path.relative_to(package).as_posix()}\0{len(source)}\0".encode())
            digest.update(source)
    return digest.hexdigest()


def remove_unused(parent: Path) -> None:
    """Remove the caches of other versions below ``parent`` that no process uses, or has used for ``UNUSED_DAYS``."""
    with suppress(OSError):
        for directory in list(parent.iterdir()):
            if re.fullmatch(f"[0-9a-f]{{{_VERSION_DIGITS}}}", directory.name) and any(directory.glob("*/*.nbi")):
                _remove_if_unused(directory)


def _use(directory: Path) -> None:
    """Hold a directory for as long as this process lives; once in a while, note that, and remove others."""
    with suppress(OSError):
        marker = directory / _MARKER
        while True:
            is_new = not marker.exists()
            held = os.open(marker, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC, 0o600)
            fcntl.flock(held, fcntl.LOCK_SH)
            if marker.exists() and os.path.samestat(os.fstat(held), marker.stat()):
                break
            os.close(held)  # it was being removed
            directory.mkdir(parents=True, exist_ok=True, mode=0o700)
        for former in _held:
            os.close(former)
        _held[:] = [held]
        if is_new or _age_days(marker) > LOOK_DAYS:
            os.utime(marker)
            remove_unused(directory.parent)


def _remove_if_unused(directory: Path) -> None:
    marker = directory / _MARKER
    with suppress(OSError):
        if _age_days(marker if marker.exists() else directory) <= UNUSED_DAYS:
            return
        with marker.open("ab") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Moved first: a process that starts now makes a new one, and never reads half of the old one.
            removed = directory.rename(directory.with_name(f"removed-{directory.name}-{os.getpid()}"))
        shutil.rmtree(removed, ignore_errors=True)


def _age_days(path: Path) -> float:
    return (time.time() - path.stat().st_mtime) / _DAY_S


def _candidates(version: str) -> Iterator[Path]:
    if chosen := os.environ.get(SETTING):
        yield Path(chosen).absolute() / version
    user_cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111 - see below
    if Path(user_cache).is_absolute():  # where there is no home "~" stays as it is, and Path.home() would raise
        yield Path(user_cache) / "threadstate" / "numba" / version
    shared = Path(tempfile.gettempdir()) / f"threadstate-numba-{os.getuid()}"
    if _can_write(shared) and shared.stat().st_uid == os.getuid():
        yield shared / version  # a cache contains code: never that of another user


def _can_write(directory: Path) -> bool:
    """Whether files can be made in ``directory``, which is itself made if missing."""
    try:
        directory.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=directory):
            return True
    except OSError:
        return False
