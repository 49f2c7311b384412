"""Puts the third-party JavaScript that ``npm ci`` fetched, with its licences, into a built wheel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCE = Path("node_modules")
TARGET = Path("service/node_modules")
FILES = {
    "swagger-ui-dist": (
        "swagger-ui-bundle.js",
        "swagger-ui-bundle.js.LICENSE.txt",
        "swagger-ui.css",
        "LICENSE",
        "NOTICE",
    ),
    "three": ("build/three.module.js", "build/three.core.js", "LICENSE"),
}
"""The files of each package that the service's pages need."""


class AssetsHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds what the service's pages need to a wheel; an editable install reads it where npm put it."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before a build of ``version`` ("standard" or "editable")."""
        if version == "standard":
            for package, names in FILES.items():
                for name in names:
                    source = Path(self.root) / SOURCE / package / name
                    build_data["force_include"][str(source)] = str(TARGET / package / name)
