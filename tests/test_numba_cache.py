from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from threadstate._numba_cache import UNUSED_DAYS, kernel_sources_hash, remove_unused

pytestmark = pytest.mark.slow

EVALUATE = (
    "import os; from threadstate.contact._branchless_kernel import larger; larger(0.5, 1.0); "
    "print(os.environ['NUMBA_CACHE_DIR'])"
)
NOT_A_DIRECTORY = "/dev/null"


@pytest.fixture
def read_only_tree(tmp_path: Path, repository_root: Path) -> Path:
    tree = tmp_path / "tree"
    shutil.copytree(repository_root / "threadstate", tree / "threadstate", ignore=shutil.ignore_patterns("__pycache__"))
    for path in (tree, *tree.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    return tree


def cache_used(tree: Path, code: str = EVALUATE, **environment: str) -> Path:
    """Where a process that imports ``tree`` and compiles a kernel caches it; its environment is only what is given."""
    run = subprocess.run(
        [sys.executable, "-B", "-c", code],
        cwd=tree,
        env={"PYTHONPATH": str(tree), "PATH": os.environ["PATH"], **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    return Path(run.stdout.strip())


def test_read_only_tree_without_home_is_imported_and_left_alone(read_only_tree: Path, tmp_path: Path) -> None:
    before = sorted(read_only_tree.rglob("*"))
    (tmp_path / "tmp").mkdir()
    cache = cache_used(read_only_tree, XDG_CACHE_HOME=NOT_A_DIRECTORY, TMPDIR=str(tmp_path / "tmp"))
    assert cache.is_relative_to(tmp_path / "tmp")
    assert list(cache.rglob("*.nbi"))
    assert sorted(read_only_tree.rglob("*")) == before


def test_unset_home_is_no_obstacle(read_only_tree: Path, tmp_path: Path) -> None:
    environment = {"HOME": NOT_A_DIRECTORY, "TMPDIR": str(tmp_path)}
    assert cache_used(read_only_tree, **environment).is_relative_to(tmp_path)


def test_temporary_directory_that_cannot_be_shared_still_works(read_only_tree: Path, tmp_path: Path) -> None:
    (tmp_path / f"threadstate-numba-{os.getuid()}").write_text("somebody else's")
    cache = cache_used(read_only_tree, HOME=NOT_A_DIRECTORY, TMPDIR=str(tmp_path))
    assert cache.parent == tmp_path
    assert list(cache.rglob("*.nbi"))


def test_setting_wins_over_home_and_numba(read_only_tree: Path, tmp_path: Path) -> None:
    chosen = tmp_path / "chosen"
    environment = {"THREADSTATE_NUMBA_CACHE_DIR": str(chosen), "HOME": str(tmp_path), "NUMBA_CACHE_DIR": "/elsewhere"}
    assert cache_used(read_only_tree, **environment).parent == chosen


def test_numba_imported_first_is_told_too(read_only_tree: Path, tmp_path: Path) -> None:
    cache = cache_used(read_only_tree, "import numba; " + EVALUATE, HOME=str(tmp_path))
    assert cache.is_relative_to(tmp_path)
    assert list(cache.rglob("*.nbi"))


def test_importing_the_package_does_not_import_numba(read_only_tree: Path, tmp_path: Path) -> None:
    code = "import sys, threadstate; assert 'numba' not in sys.modules; print()"
    cache_used(read_only_tree, code, HOME=str(tmp_path))


def test_hash_follows_kernels_alone(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text("@njit\ndef f(): return 1\n")
    (tmp_path / "other.py").write_text("x = 1\n")
    first = kernel_sources_hash(tmp_path)
    (tmp_path / "other.py").write_text("x = 2\n")
    assert kernel_sources_hash(tmp_path) == first
    (tmp_path / "kernel.py").write_text("@njit\ndef f(): return 2\n")
    assert kernel_sources_hash(tmp_path) != first


@pytest.mark.parametrize("mark", ["@kernel(contract=True)\n", "from numba.core.codegen import JITCodeLibrary\n"])
def test_hash_follows_whatever_is_compiled(tmp_path: Path, mark: str) -> None:
    (tmp_path / "kernel.py").write_text(f"{mark}def f(): return 1\n")
    first = kernel_sources_hash(tmp_path)
    (tmp_path / "kernel.py").write_text(f"{mark}def f(): return 2\n")
    assert kernel_sources_hash(tmp_path) != first


OLD, YOUNG, LOCKED, MADE_BEFORE = (digit * 16 for digit in "0123")
OTHERS = ("f" * 15, "somebody-elses", "a" * 16)


@pytest.fixture
def caches(tmp_path: Path) -> Path:
    """Caches of other versions: unused for long, used lately, in use for long, without a marker; and no cache."""
    parent = tmp_path / "caches"
    long_ago = time.time() - (UNUSED_DAYS + 1.0) * 86400.0
    for name in (OLD, YOUNG, LOCKED, MADE_BEFORE, *OTHERS[:2]):
        (parent / name / "contact_0").mkdir(parents=True)
        (parent / name / "contact_0" / "kernel.nbi").touch()
        if name != MADE_BEFORE:
            (parent / name / "used").touch()
    (parent / OTHERS[2]).mkdir()
    for path in (*(parent / name / "used" for name in (OLD, LOCKED)), parent / MADE_BEFORE, parent / OTHERS[2]):
        os.utime(path, (long_ago, long_ago))
    return parent


USES_FOR_A_WHILE = """
import sys
from pathlib import Path
from threadstate import _numba_cache
_numba_cache._use(Path(sys.argv[1]))
print("held", flush=True)
sys.stdin.read()
"""


def test_caches_are_removed_that_no_process_has_used_for_long(caches: Path) -> None:
    held = caches / LOCKED
    long_ago = (held / "used").stat().st_mtime
    with subprocess.Popen(
        [sys.executable, "-c", USES_FOR_A_WHILE, str(held)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as using:
        assert using.stdout is not None
        assert using.stdout.readline() == b"held\n"
        # It has noted its use and looked at the others.
        assert (held / "used").stat().st_mtime > long_ago
        assert {path.name for path in caches.iterdir()} == {YOUNG, LOCKED, *OTHERS}
        # One that runs for longer than that is left alone for as long as it runs.
        os.utime(held / "used", (long_ago, long_ago))
        remove_unused(caches)
        assert list(held.rglob("*.nbi"))
        using.communicate()
    remove_unused(caches)
    assert {path.name for path in caches.iterdir()} == {YOUNG, *OTHERS}


def test_a_process_uses_the_directory_that_it_was_given_by_the_one_that_started_it(caches: Path) -> None:
    code = "import os; from threadstate._numba_cache import _held; print(os.readlink(f'/proc/self/fd/{_held[0]}'))"
    for name, expected in ((YOUNG, 0), (OTHERS[2], 1)):
        run = subprocess.run(
            [sys.executable, "-c", code],
            env={"PYTHONPATH": str(Path.cwd()), "PATH": os.environ["PATH"], "NUMBA_CACHE_DIR": str(caches / name)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.returncode == expected
        assert run.stdout.strip() == ("" if expected else str(caches / name / "used"))


def test_versions_that_come_and_go_leave_one_cache(read_only_tree: Path, tmp_path: Path) -> None:
    first = cache_used(read_only_tree, HOME=str(tmp_path))
    long_ago = time.time() - (UNUSED_DAYS + 1.0) * 86400.0
    os.utime(first / "used", (long_ago, long_ago))
    kernel = read_only_tree / "threadstate" / "thread" / "_profile_kernel.py"
    kernel.chmod(0o644)
    kernel.write_text(kernel.read_text() + "# changed\n")
    second = cache_used(read_only_tree, HOME=str(tmp_path))
    assert second != first
    assert list(second.parent.iterdir()) == [second]
