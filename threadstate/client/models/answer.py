"""Base classes of the response models."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar

from pydantic import BaseModel, ConfigDict

Vector = tuple[float, float, float]

Item_co = TypeVar("Item_co", covariant=True)


class Answer(BaseModel):
    """A response or a part of one: frozen, and populated by field names."""

    model_config = ConfigDict(frozen=True, populate_by_name=True, extra="ignore")


class Page(Protocol[Item_co]):
    """A page of a longer list."""

    @property
    def next(self) -> str | None:
        """Address of the next page; None on the last."""

    @property
    def items(self) -> Sequence[Item_co]:
        """What the page holds."""
