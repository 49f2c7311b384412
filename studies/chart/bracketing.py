"""A process of its own for the exact method with another number of boxes: a pickled job on stdin, its run on stdout."""

from __future__ import annotations

import pickle
import sys

from studies.chart.exact import use_boxes
from studies.chart.measure import run


def main() -> None:
    """Compile for the number of boxes that is the argument, and run the job."""
    use_boxes(int(sys.argv[1]))
    contestant, pair, poses = pickle.loads(sys.stdin.buffer.read())
    sys.stdout.buffer.write(pickle.dumps(run(contestant, pair, poses)))


if __name__ == "__main__":
    main()
