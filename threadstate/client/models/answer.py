"""What all answers of the service have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar

from pydantic import BaseModel, ConfigDict

Vector = tuple[float, float, float]

Item_co = TypeVar("Item_co", covariant=True)


class Answer(BaseModel):
    """An answer, or a part of one: it does not change, and it is made by the names of its fields."""

    model_config = ConfigDict(frozen=True, populate_by_name=True, extra="ignore")


class Page(Protocol[Item_co]):
    """A page of a longer list."""

    @property
    def next(self) -> str | None:
        """Address of the next page; None on the last."""

    @property
    def items(self) -> Sequence[Item_co]:
        """What the page holds."""
