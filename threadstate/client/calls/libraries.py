"""Requests for libraries and what is in them as a whole."""

from __future__ import annotations

from threadstate.client.call import LATEST, Call, LibraryName, get, get_content, library_path, path_of
from threadstate.client.models.libraries import BuildingList, LibraryDetail, LibraryList, OrientationsAnswer

GLB = "model/gltf-binary"


def libraries(*, unit: str | None = None) -> Call[LibraryList]:
    """All published libraries, the latest first."""
    return get(path_of("v1", "libraries"), LibraryList, unit=unit)


def library(library: LibraryName = LATEST, *, unit: str | None = None) -> Call[LibraryDetail]:
    """What a library was computed from, and how many of its states have each class and each flag."""
    return get(library_path(library), LibraryDetail, unit=unit)


def building() -> Call[BuildingList]:
    """The libraries that are begun and not published, and how far each is."""
    return get(path_of("v1", "building"), BuildingList)


def orientations(*, library: LibraryName = LATEST, unit: str | None = None) -> Call[OrientationsAnswer]:
    """Each orientation over all phases: how many states of each class, and the extremes of what is measured."""
    return get(library_path(library, "orientations"), OrientationsAnswer, unit=unit)


def mesh(part: str, *, library: LibraryName = LATEST) -> Call[bytes]:
    """The ``bolt`` or the ``nut`` as a closed mesh (GLB), in its own frame and the library's own unit."""
    return get_content(library_path(library, "meshes", part), GLB)
