from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from threadstate._numba_cache import kernel_sources_hash

pytestmark = pytest.mark.slow

EVALUATE = (
    "import os; from threadstate.thread._profile_kernel import fold; fold(0.01, 0.05); "
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
    """Where a process that imports ``tree`` and compiles a kernel keeps it; its environment is as given and no more."""
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
