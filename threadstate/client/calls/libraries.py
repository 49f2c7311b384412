"""Requests for libraries, their summaries and exports, and for the service's own state."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.client.call import LATEST, Call, LibraryName, get, get_content, joined, library_path, path_of
from threadstate.client.models.libraries import (
    BuildingList,
    ComparisonDocument,
    LibraryDetail,
    LibraryList,
    OrientationsAnswer,
)
from threadstate.client.models.service import Health, Readiness

GLB = "model/gltf-binary"


def libraries(*, unit: str | None = None) -> Call[LibraryList]:
    """All published libraries, the latest first."""
    return get(path_of("v1", "libraries"), LibraryList, unit=unit)


def library(library: LibraryName = LATEST, *, unit: str | None = None) -> Call[LibraryDetail]:
    """What a library was computed from, and number of its states of each class and each flag."""
    return get(library_path(library), LibraryDetail, unit=unit)


def building() -> Call[BuildingList]:
    """The libraries that are not published yet, and their progress."""
    return get(path_of("v1", "building"), BuildingList)


def orientations(*, library: LibraryName = LATEST, unit: str | None = None) -> Call[OrientationsAnswer]:
    """Each orientation over all phases: the number of states of each class, and extremes of the lengths."""
    return get(library_path(library, "orientations"), OrientationsAnswer, unit=unit)


def compare(libraries: Sequence[LibraryName] = (LATEST,)) -> Call[ComparisonDocument]:
    """Windows, snaps, classes, frictions and embedment of libraries side by side; lengths in thread pitches."""
    return get(path_of("v1", "compare"), ComparisonDocument, libraries=joined(map(str, libraries)))


def mesh(part: str, *, library: LibraryName = LATEST) -> Call[bytes]:
    """The ``bolt`` or the ``nut`` as a closed mesh (GLB), in its own frame and the library's own unit."""
    return get_content(library_path(library, "meshes", part), GLB)


def export(table: str, file_format: str, *, library: LibraryName = LATEST, unit: str | None = None) -> Call[bytes]:
    """A table of a library in a format, as a stream."""
    return get_content(library_path(library, "export", f"{table}.{file_format}"), "*/*", unit=unit)


def health() -> Call[Health]:
    """Whether the process is alive."""
    return get(path_of("healthz"), Health)


def readiness() -> Call[Readiness]:
    """Whether the service is ready; if not, a ``ServiceUnavailableError`` without retries."""
    return Call("GET", path_of("readyz"), Readiness.model_validate_json, repeatable=False)
