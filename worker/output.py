"""The output of commands: data on stdout, everything else on stderr."""

from __future__ import annotations

import json
import sys


def print_line(line: str) -> None:
    """Print a line of data."""
    sys.stdout.write(f"{line}\n")


def print_json(value: object) -> None:
    """Print a value as one line of compact JSON."""
    print_line(json.dumps(value, separators=(",", ":"), allow_nan=False))


def print_text(text: bytes) -> None:
    """Print UTF-8 text of complete lines."""
    sys.stdout.write(text.decode())


def print_status(line: str) -> None:
    """Print a status line on stderr."""
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()
