"""``/v1/libraries/{id}/meshes/{part}``."""

from __future__ import annotations

import gzip
from functools import lru_cache
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from pydantic import TypeAdapter

from service.libraries.requested import IdentifiedLibrary
from service.representation import NOT_MODIFIED, zipped_representation
from threadstate.mesh.presets import Preset
from threadstate.thread.pair import Pair, Part

router = APIRouter(prefix="/v1/libraries/{id}/meshes", tags=["meshes"])

GLB = "model/gltf-binary"
PartPath = Annotated[Part, Path(description="bolt or nut")]
_PAIR = TypeAdapter(Pair)
_CACHE_SIZE = 16


@router.get(
    "/{part}",
    summary="Bolt or nut as a mesh",
    response_class=Response,
    responses={200: {"content": {GLB: {"schema": {"type": "string", "format": "binary"}}}}, **NOT_MODIFIED},
)
def get_mesh(request: Request, library: IdentifiedLibrary, part: PartPath) -> Response:
    """The part in its own frame, one thread pitch long, as GLB in the library's own unit; compressed where the client
    takes gzip.
    """
    content, zipped = _glb(library.pair, part)
    return zipped_representation(request, content, zipped, GLB)


@lru_cache(maxsize=_CACHE_SIZE)
def _glb(pair: str, part: Part) -> tuple[bytes, bytes]:
    """The part of a pair (as JSON) as GLB, and compressed by gzip; cached, as it takes some 0.1 s."""
    # Imported late: the service starts without the mesh libraries, which the rest does not need.
    from threadstate.mesh.export import glb_by_face
    from threadstate.mesh.part import part_solid

    content = glb_by_face(part_solid(_PAIR.validate_json(pair), part, Preset.PAPER.tessellation))
    return content, gzip.compress(content, mtime=0)
