"""``python -m studies.certificate.states``: how far states are from exact ones, by kind of pose; prints a table."""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from flint import arb, ctx

from studies.certificate.exact import PRECISION, ExactState, Floats, UncoveredError, exact_state, stage_from_record
from threadstate.contact import _record_kernel as rk
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair

PAIRS = (
    "1/4-20 UNC",
    "M6",
    "1/4-20 BSW",
    "1/4-16 ACME-2G at minimum material",
    "1/4-16 ACME-2G with sharp corners",
)
KINDS = ("near in phase", "any phase", "nearly level")
SEED = 30

QUANTITIES = ("height", "second turn", "third turn", "first place", "second place", "third place")
OWN = ("second place, own", "third turn, own")
"""How far these are from what follows exactly from the record's numbers of earlier stages: the error of the stage
where it goes on from these numbers, else what it would cost to do so."""

SOLVING = """
import sys
import numpy as np
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.catalogue import pair_by_designation

asked = np.load(sys.argv[1])
np.savez(sys.argv[2], **{
    name: solve_records(pair_by_designation(name.split("|")[0]), SolveOptions(), asked[name]) for name in asked.files
})
"""


def random_poses(kind: str, count: int) -> Floats:
    """Poses of shape (count, 3), roll, pitch, phase in degrees; the same for the same kind and number."""
    choose = np.random.default_rng([SEED, KINDS.index(kind)])
    if kind == "nearly level":
        tilts = 10.0 ** choose.uniform(-6.0, -2.0, (count, 1)) * choose.uniform(-1.0, 1.0, (count, 2))
        return np.column_stack([tilts, choose.uniform(-8.0, 8.0, count)])
    low, high = (-20.0, 20.0) if kind == "near in phase" else (0.0, 360.0)
    return np.column_stack([choose.uniform(-4.0, 4.0, (count, 2)), choose.uniform(low, high, count)])


def records_of(checkout: Path, poses: dict[str, Floats]) -> dict[str, Floats]:
    """The records of poses by pair and kind (``pair|kind``), solved by the package in a checkout."""
    with tempfile.TemporaryDirectory() as folder:
        asked, answered = Path(folder) / "poses.npz", Path(folder) / "records.npz"
        np.savez(asked, **poses)  # type: ignore[arg-type]
        environment = {**os.environ, "PYTHONPATH": str(checkout)}
        subprocess.run([sys.executable, "-c", SOLVING, asked, answered], cwd=folder, env=environment, check=True)
        with np.load(answered) as found:
            return {name: found[name] for name in poses}


def errors(pair: Pair, exact: ExactState, record: Floats) -> dict[str, float]:
    """How far a record is from the exact state: turns in rad, the height and places in thread pitches.

    A quantity that the state does not have is absent. ``record`` has shape (RECORD_SIZE,).
    """
    p = pair.thread_pitch
    listed = record[rk.O_CONTACT :].reshape(-1, rk.POINT_SIZE)
    with ctx.workprec(PRECISION):
        found = {"height": distance((exact.height,), record[[rk.O_POSE + 11]]) / p}
        for name, turn, column in zip(QUANTITIES[1:3], exact.turns, (rk.O_LAMBDA, rk.O_MU), strict=True):
            if turn is not None:
                found[name] = distance((turn,), record[[column]])
        for name, contact, one in zip(QUANTITIES[3:], exact.contacts, listed, strict=False):
            found[name] = distance(contact.point, one[rk.P_POINT : rk.P_POINT + 3]) / p
    return found


def own_errors(pair: Pair, exact: ExactState, record: Floats) -> dict[str, float]:
    """The errors of ``OWN``, as far as the record's own numbers lead to a contact."""
    listed, found = record[rk.O_CONTACT :].reshape(-1, rk.POINT_SIZE), {}
    with ctx.workprec(PRECISION):
        for stage, name in zip(range(2, 1 + len(exact.contacts)), OWN, strict=False):
            try:
                contact, turn = stage_from_record(pair, record, stage)
            except UncoveredError:
                continue
            place = listed[stage - 1, rk.P_POINT : rk.P_POINT + 3]
            second = distance(contact.point, place) / pair.thread_pitch
            found[name] = second if stage == 2 else distance((turn,), record[[rk.O_MU]])
    return found


def distance(exact: tuple[arb, ...], numbers: Floats) -> float:
    """The distance of points whose coordinates are given exactly and in doubles."""
    return math.hypot(*(float((a - arb(float(b))).mid()) for a, b in zip(exact, numbers, strict=True)))


@dataclass
class Comparison:
    """What was found of the states of one pair and kind: each quantity's errors, and why states are not covered."""

    errors: dict[str, list[float]] = field(default_factory=dict)
    uncovered: Counter[str] = field(default_factory=Counter)

    def add(self, pair: Pair, pose_deg: Floats, record: Floats) -> None:
        """Put a record beside the exact state."""
        try:
            exact = exact_state(pair, pose_deg, record)
        except UncoveredError as error:
            self.uncovered[str(error)] += 1
            return
        found = errors(pair, exact, record) | own_errors(pair, exact, record)
        for name, size in found.items():
            self.errors.setdefault(name, []).append(size)


def compared(designation: str, poses_deg: Floats, records: Floats) -> Comparison:
    """The comparison of the records of poses, both by rows, with the exact states."""
    pair, found = pair_by_designation(designation), Comparison()
    for pose, record in zip(poses_deg, records, strict=True):
        found.add(pair, pose, record)
    return found


def row(name: str, found: Comparison) -> str:
    """A line of the table: the number of states compared, the largest errors, and what is not covered."""
    largest = (max(found.errors.get(one, [0.0])) for one in (*QUANTITIES, *OWN))
    left = "; ".join(f"{count} {reason}" for reason, count in sorted(found.uncovered.items()))
    count = len(found.errors.get("height", []))
    return f"| {name} | {count:,} | {' | '.join(f'{one:.1e}' for one in largest)} | {left} |"


def main() -> None:
    """Solve, compare and print."""
    parser = argparse.ArgumentParser(prog="python -m studies.certificate.states", description=__doc__)
    parser.add_argument("--poses", type=int, default=400, help="of each pair and kind [%(default)s]")
    parser.add_argument("--pairs", nargs="+", default=PAIRS, metavar="PAIR", help="designations [five of them]")
    parser.add_argument("--beside", type=Path, metavar="CHECKOUT", help="states of the package there, too")
    arguments = parser.parse_args()
    here = Path(__file__).parents[2]
    poses = {f"{pair}|{kind}": random_poses(kind, arguments.poses) for pair in arguments.pairs for kind in KINDS}
    print(f"| states | compared | {' | '.join((*QUANTITIES, *OWN))} | not compared |")
    print("|---" * (len(QUANTITIES) + len(OWN) + 3) + "|")
    for checkout in (here, *([arguments.beside] if arguments.beside else [])):
        records = records_of(checkout, poses)
        for name, asked in poses.items():
            designation, kind = name.split("|")
            label = f"{designation}, {kind}" + ("" if checkout == here else f", {checkout}")
            print(row(label, compared(designation, asked, records[name])), flush=True)


if __name__ == "__main__":
    main()
