"""Builds the site: ``python -m scripts.docs_site [FOLDER]``, ``make site``."""

from __future__ import annotations

import argparse
from pathlib import Path

from scripts.docs_site.build import build_site

ROOT = Path(__file__).parents[2]


def main() -> None:
    """Build the site into a folder, which is replaced."""
    parser = argparse.ArgumentParser(description="Build the site of the documentation.")
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "site", help="where to; default: site")
    folder = parser.parse_args().folder
    build_site(ROOT, folder)
    print(f"{folder / 'index.html'}")


if __name__ == "__main__":
    main()
