"""What a command prints: data on stdout, everything else on stderr."""

from __future__ import annotations

import json
import sys


def print_line(line: str) -> None:
    """A line of data."""
    sys.stdout.write(f"{line}\n")


def print_json(value: object) -> None:
    """A value as one line of compact JSON."""
    print_line(json.dumps(value, separators=(",", ":"), allow_nan=False))


def print_text(text: bytes) -> None:
    """Text that is whole lines already, in UTF-8."""
    sys.stdout.write(text.decode())


def tell(line: str) -> None:
    """A line for whoever is watching."""
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()
