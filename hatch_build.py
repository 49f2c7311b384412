"""Puts the third-party JavaScript that ``npm ci`` fetched, with its licence, into a built wheel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCE = Path("node_modules/swagger-ui-dist")
TARGET = Path("service/docs/assets")
FILES = ("swagger-ui-bundle.js", "swagger-ui-bundle.js.LICENSE.txt", "swagger-ui.css", "LICENSE", "NOTICE")


class AssetsHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the assets of ``/docs`` to a wheel; an editable install reads them where npm put them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before a build of ``version`` ("standard" or "editable")."""
        if version == "standard":
            for name in FILES:
                build_data["force_include"][str(Path(self.root) / SOURCE / name)] = str(TARGET / name)
