"""The cache directory of compiled kernels: chosen before numba is imported; a failure never breaks an import.

The directory is the first of these that can be written to:

1. ``THREADSTATE_NUMBA_CACHE_DIR``, if set;
2. ``threadstate/numba`` under the user's cache directory (``XDG_CACHE_HOME``, else ``~/.cache``);
3. a directory of this user's own under the system's directory for temporary files;
4. a fresh temporary directory (kernels are then compiled again in every process).

Inside it, the sources of all kernels choose a subdirectory by their hash: numba compares a kernel's own file alone, so
without that a kernel compiled against an older version of one that it calls would still be used.
A ``NUMBA_CACHE_DIR`` that the user has set himself is left as it is, unless ``THREADSTATE_NUMBA_CACHE_DIR`` is set.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

SETTING = "THREADSTATE_NUMBA_CACHE_DIR"
_NUMBA_SETTING = "NUMBA_CACHE_DIR"


def choose_numba_cache() -> None:
    """Set numba's cache directory for this process and those it starts; does not import numba."""
    if os.environ.get(_NUMBA_SETTING) and not os.environ.get(SETTING):
        return
    version = kernel_sources_hash(Path(__file__).parent)[:16]
    directory = next((path for path in _candidates(version) if _can_write(path)), None)
    os.environ[_NUMBA_SETTING] = str(directory or tempfile.mkdtemp(prefix="threadstate-numba-"))
    if "numba" in sys.modules:
        sys.modules["numba"].config.reload_config()


def kernel_sources_hash(package: Path) -> str:
    """SHA-256, in hexadecimal, of the names and bytes of all files under ``package`` that hold numba kernels."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"njit" in source:
            digest.update(f"{path.relative_to(package).as_posix()}\0{len(source)}\0".encode())
            digest.update(source)
    return digest.hexdigest()


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
