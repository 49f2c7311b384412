"""The navigation of the site, derived from the index of the pages, docs/README.md."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TypeAlias

SECTION = re.compile(r"^## (?P<title>.*)$")
ENTRY = re.compile(r"^- \[(?P<title>[^\]]+)\]\((?P<page>[^)#]+)\): (?P<line>\S.*)$")

Navigation: TypeAlias = "list[str | dict[str, str | Navigation]]"
"""As the site generator takes it: pages, with or without a title, and sections of them."""


@dataclass(frozen=True)
class Entry:
    """A page of the index: its title, and its path from the folder of the index."""

    title: str
    page: str


@dataclass(frozen=True)
class Section:
    """A section of the index, with its pages in order."""

    title: str
    entries: tuple[Entry, ...]


def sections_of(index: str) -> list[Section]:
    """The sections of the index that have pages."""
    sections: list[tuple[str, list[Entry]]] = []
    for line in index.splitlines():
        if heading := SECTION.match(line):
            sections.append((heading["title"], []))
        elif entry := ENTRY.match(line):
            sections[-1][1].append(Entry(entry["title"], entry["page"]))
    return [Section(title, tuple(entries)) for title, entries in sections if entries]


def navigation_of(
    sections: Sequence[Section],
    addresses: Mapping[PurePosixPath, PurePosixPath],
    headings: Mapping[PurePosixPath, str],
    below: Mapping[PurePosixPath, Navigation],
    folder: PurePosixPath,
) -> Navigation:
    """The navigation of an index in ``folder``.

    ``addresses`` and ``headings`` have the path in the site and the first heading of each page of the repository,
    ``below`` the pages that belong to one. An entry whose title is a number is called by the first part of the page's
    heading.
    """
    navigation: Navigation = []
    for section in sections:
        pages: Navigation = []
        for entry in section.entries:
            source = normal(folder / entry.page)
            title = headings[source].partition(":")[0] if entry.title.isdecimal() else entry.title
            address = str(addresses[source])
            pages.append({title: [address, *below[source]] if source in below else address})
        navigation.append({section.title: pages})
    return navigation


def normal(path: PurePosixPath) -> PurePosixPath:
    """A relative path without ``.`` and ``..``, where these do not lead out of it."""
    parts: list[str] = []
    for part in path.parts:
        if part == ".." and parts and parts[-1] != "..":
            parts.pop()
        elif part != ".":
            parts.append(part)
    return PurePosixPath(*parts)
