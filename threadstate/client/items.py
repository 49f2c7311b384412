"""Lists that come page by page, as they are walked."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from typing import TYPE_CHECKING, Generic, TypeVar

from threadstate.client.async_courier import AsyncCourier
from threadstate.client.call import Call, PagedCall
from threadstate.client.courier import Courier
from threadstate.client.frames import to_pandas, to_polars
from threadstate.client.models.answer import Page

if TYPE_CHECKING:
    import pandas
    import polars

Item = TypeVar("Item")


class Items(Generic[Item]):
    """A list; every walk asks the service anew, one page at a time, and only as far as it goes."""

    def __init__(self, courier: Courier, call: PagedCall[Item]) -> None:
        self._courier = courier
        self._call = call

    def __iter__(self) -> Iterator[Item]:
        for page in self.pages():
            yield from page.items

    def pages(self) -> Iterator[Page[Item]]:
        """The pages, with all that they say beside their items."""
        call: Call[Page[Item]] | None = self._call.first
        while call is not None:
            page = self._courier.send(call)
            yield page
            call = self._call.after(page)

    def to_pandas(self) -> pandas.DataFrame:
        """All of it as a frame of pandas (extra ``pandas``)."""
        return to_pandas(self, self._call.item)

    def to_polars(self) -> polars.DataFrame:
        """All of it as a frame of polars (extra ``polars``)."""
        return to_polars(self, self._call.item)


class AsyncItems(Generic[Item]):
    """The same, of an asynchronous client."""

    def __init__(self, courier: AsyncCourier, call: PagedCall[Item]) -> None:
        self._courier = courier
        self._call = call

    async def __aiter__(self) -> AsyncIterator[Item]:
        async for page in self.pages():
            for item in page.items:
                yield item

    async def pages(self) -> AsyncIterator[Page[Item]]:
        """The pages, with all that they say beside their items."""
        call: Call[Page[Item]] | None = self._call.first
        while call is not None:
            page = await self._courier.send(call)
            yield page
            call = self._call.after(page)

    async def to_pandas(self) -> pandas.DataFrame:
        """All of it as a frame of pandas (extra ``pandas``)."""
        return to_pandas([item async for item in self], self._call.item)

    async def to_polars(self) -> polars.DataFrame:
        """All of it as a frame of polars (extra ``polars``)."""
        return to_polars([item async for item in self], self._call.item)
