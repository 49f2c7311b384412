"""The nine regions of a thread (method, section 3)."""

from __future__ import annotations

from enum import StrEnum


class Region(StrEnum):
    """Where on a part a contact lies; the eight thread regions in order of growing axial position.

    ``BASE`` is the bolt's cut end, ``SURFACE`` the nut's; ``CHAMFER`` is the cone of a chamfered bolt. On the bolt the
    crest is the largest radius, on the nut the smallest; a flank (and its fillets) is positive where the radius grows
    with +z.
    """

    ROOT = "root"
    ROOT_FILLET_POS = "root_fillet_pos"
    FLANK_POS = "flank_pos"
    CREST_FILLET_POS = "crest_fillet_pos"
    CREST = "crest"
    CREST_FILLET_NEG = "crest_fillet_neg"
    FLANK_NEG = "flank_neg"
    ROOT_FILLET_NEG = "root_fillet_neg"
    BASE = "base"
    SURFACE = "surface"
    CHAMFER = "chamfer"


BOLT_REGIONS: tuple[Region, ...] = (
    Region.ROOT,
    Region.ROOT_FILLET_POS,
    Region.FLANK_POS,
    Region.CREST_FILLET_POS,
    Region.CREST,
    Region.CREST_FILLET_NEG,
    Region.FLANK_NEG,
    Region.ROOT_FILLET_NEG,
    Region.BASE,
)
"""The bolt's regions; the first eight in order of growing ``s`` from the middle of the small-radius flat."""

SIDE_REGIONS = (*BOLT_REGIONS, Region.CHAMFER)
"""The regions of a bolt that may have a chamfer, which the mesh method alone takes."""

NUT_REGIONS: tuple[Region, ...] = (
    Region.CREST,
    Region.CREST_FILLET_POS,
    Region.FLANK_POS,
    Region.ROOT_FILLET_POS,
    Region.ROOT,
    Region.ROOT_FILLET_NEG,
    Region.FLANK_NEG,
    Region.CREST_FILLET_NEG,
    Region.SURFACE,
)
"""The nut's regions; the first eight in order of growing ``s`` from the middle of the small-radius flat."""
