"""Requests for a whole library as a file."""

from __future__ import annotations

from threadstate.client.call import LATEST, Call, LibraryName, get_content, library_path


def export(table: str, file_format: str, *, library: LibraryName = LATEST, unit: str | None = None) -> Call[bytes]:
    """A table of a library in a format, to be read as it comes."""
    return get_content(library_path(library, "export", f"{table}.{file_format}"), "*/*", unit=unit)
