"""How thread on thread is searched, setting by setting: what changes, and what it costs.

A setting is a change of the kernels' own text: each runs in a copy of the package, compiled for itself.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from threadstate.contact._stage_kernel import RESOLVED
from threadstate.thread.catalogue import pair_by_designation

Floats = NDArray[np.float64]

ROOT = Path(__file__).parents[2]
STATUS, HEIGHT, LAMBDA, MU, EMBEDMENT, SECONDS = range(6)
AGREEMENT = 1e-9
"""Heights within this many thread pitches and turns within as many radians are the same."""
SEED = 20061120

AZIMUTHS, INSTANTS = "_stage_kernel.py", "_ridge_kernel.py"
RIDGES = "RIDGE_AZIMUTHS = 32"
STEP = "INSTANT_STEP = math.radians(1.5)"
BEGINNING = "BEGINNING_INSTANTS, BEGINNING_AZIMUTHS = 12, 64"


@dataclass(frozen=True)
class Setting:
    """A way to search for thread on thread.

    Attributes:
        name: as on the page.
        texts: what is replaced in which file of ``threadstate/contact``, by what.
        prove: whether rectangles are closed at every stage instead.
        most: of how many poses of each pair at the most; None: of all.
    """

    name: str
    texts: Sequence[tuple[str, str, str]] = ()
    prove: bool = False
    most: int | None = None


DEFAULT = Setting("32 azimuths, 1.5 deg (in use)")
PROVED = Setting("rectangles to 2e-3 rad", prove=True, most=100)
FINE_INSTANTS = (
    (INSTANTS, f"\n{STEP}", "\nINSTANT_STEP = math.radians(0.75)"),
    (INSTANTS, BEGINNING, "BEGINNING_INSTANTS, BEGINNING_AZIMUTHS = 24, 64"),
)
SETTINGS = (
    Setting("16 azimuths, 1.5 deg", ((AZIMUTHS, RIDGES, "RIDGE_AZIMUTHS = 16"),)),
    Setting("32 azimuths, 3 deg", ((INSTANTS, f"\n{STEP}", "\nINSTANT_STEP = math.radians(3.0)"),)),
    DEFAULT,
    Setting("64 azimuths, 1.5 deg", ((AZIMUTHS, RIDGES, "RIDGE_AZIMUTHS = 64"),)),
    Setting("32 azimuths, 0.75 deg", FINE_INSTANTS),
    Setting("64 azimuths, 0.75 deg", ((AZIMUTHS, RIDGES, "RIDGE_AZIMUTHS = 64"), *FINE_INSTANTS)),
    PROVED,
)
PAIRS = (
    "1/4-20 UNC",
    "M3x0.5 at minimum material",
    "1/4-16 ACME-2G at minimum material",
    "1/4-28 UNJF-3A/3B",
    "1/4-20 BSW",
)


@dataclass
class Compared:
    """Poses of one pair under one setting.

    Attributes:
        poses: how many.
        seconds: processor time of all together.
        seconds_in_use: that of the same poses with the setting in use.
        late: those of which a contact is found later than by another setting, or not at all, as (roll, pitch, phase) in
            degrees.
        refused: those without an answer.
    """

    poses: int = 0
    seconds: float = 0.0
    seconds_in_use: float = 0.0
    late: list[tuple[float, float, float]] = field(default_factory=list)
    refused: int = 0


def drawn_poses(count: int, names: Sequence[str] = PAIRS) -> dict[str, Floats]:
    """Random poses (degrees), ``count`` of each pair: roll and pitch up to 4 deg, every other one within 20 deg of the
    phases at which the bolt drops deepest.
    """
    rng = np.random.default_rng(SEED)
    poses = {}
    for name in names:
        some = rng.uniform((-4.0, -4.0, 0.0), (4.0, 4.0, 360.0), (count, 3))
        some[::2, 2] = rng.uniform(-20.0, 20.0, len(some[::2])) % 360.0
        poses[name] = some
    return poses


def solved(setting: Setting, poses: Mapping[str, Floats], folder: Path) -> dict[str, Floats]:
    """What :mod:`studies.certainty.measure` finds in a copy of the package with that setting, made in ``folder``.

    Rows of NaN are of poses that it is not asked for.

    Raises:
        subprocess.CalledProcessError: it failed.
    """
    copy_package(setting, folder)
    given, results = folder / "poses.npz", folder / "found.npz"
    with given.open("wb") as file:
        np.savez(file, **{name: some[: setting.most] for name, some in poses.items()})  # type: ignore[arg-type]
    way = "prove" if setting.prove else "search"
    subprocess.run(
        [sys.executable, "-m", "studies.certainty.measure", str(given), str(results), way],
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "NUMBA_CACHE_DIR")},
        check=True,
    )
    found = np.load(results)
    return {
        name: np.pad(found[name], ((0, len(some) - len(found[name])), (0, 0)), constant_values=np.nan)
        for name, some in poses.items()
    }


def copy_package(setting: Setting, folder: Path) -> None:
    """A copy of the package in ``folder``, unless it is there, with the texts of a setting replaced.

    Raises:
        ValueError: a text is not there exactly once.
    """
    if folder.exists():
        return
    for package in ("threadstate", "studies"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    for file, text, other in setting.texts:
        path = folder / "threadstate" / "contact" / file
        source = path.read_text()
        if source.count(text) != 1:
            raise ValueError(f"{text!r} is {source.count(text)} times in {path}")
        path.write_text(source.replace(text, other))


def compared(poses: Mapping[str, Floats], found: Mapping[str, Mapping[str, Floats]]) -> dict[str, dict[str, Compared]]:
    """Per setting's name and pair: what it finds later than the earliest that any setting finds.

    A contact that is found is there: it is refined on the surfaces themselves. So of two settings that differ the one
    whose contact comes first is right, and that of the other is late.
    """
    result: dict[str, dict[str, Compared]] = {setting: {} for setting in found}
    for name, some in poses.items():
        pitch = pair_by_designation(name).thread_pitch
        rows = {setting: found[setting][name] for setting in found}
        late = dict.fromkeys(rows, np.zeros(len(some), dtype=bool))
        for i, rank in _ranks(rows, pitch):
            for setting, is_late in zip(rows, rank, strict=True):
                if is_late:
                    late[setting] = late[setting] | (np.arange(len(some)) == i)
        for setting, row in rows.items():
            asked = ~np.isnan(row[:, STATUS])
            result[setting][name] = Compared(
                int(asked.sum()),
                float(row[asked, SECONDS].sum()),
                float(rows[DEFAULT.name][asked, SECONDS].sum()),
                [(float(a), float(b), float(c)) for a, b, c in some[late[setting]]],
                int((row[asked, STATUS] != RESOLVED).sum()),
            )
    return result


def _ranks(rows: Mapping[str, Floats], pitch: float) -> Iterator[tuple[int, list[bool]]]:
    """Per pose on which settings differ, which of them are late: at the first stage at which they do.

    The first contact is the highest one, later ones are those of the least turn. The embedment is the least lift that
    frees the bolt: a better search finds more of it. NaN is that there is none.
    """
    table = np.stack(list(rows.values()))
    resolved = table[:, :, STATUS] == RESOLVED
    for i in range(table.shape[1]):
        among = resolved[:, i].copy()
        is_late = np.zeros(len(table), dtype=bool)
        for column, sign, unit in ((HEIGHT, 1.0, pitch), (LAMBDA, -1.0, 1.0), (MU, -1.0, 1.0), (EMBEDMENT, 1.0, pitch)):
            values = np.nan_to_num(sign * table[:, i, column] / unit, nan=-np.inf)
            if not among.any():
                break
            best = values[among].max()
            behind = among & (values < best - AGREEMENT)
            is_late |= behind
            among &= ~behind
        if is_late.any():
            yield i, is_late.tolist()
