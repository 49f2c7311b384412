"""Where in a file something is, for errors that name it."""

from __future__ import annotations

from dataclasses import dataclass
from types import TracebackType

from threadstate.errors import InvalidValueError


@dataclass(frozen=True)
class Place:
    """A table of a file.

    As a context it puts itself before the name of what an InvalidValueError in it is about; ``exact`` where it is that
    itself.
    """

    path: str
    exact: bool = False

    def __truediv__(self, key: str) -> Place:
        """The table under a key of this one."""
        return Place(f"{self.path}{'' if self.path.endswith(': ') else '.'}{key}")

    def at(self, key: str) -> Place:
        """The value of a key, as a context."""
        return Place((self / key).path, exact=True)

    def invalid(self, key: str, value: object, valid: str) -> InvalidValueError:
        """The error that the value of a key is not valid."""
        return InvalidValueError((self / key).path, value, valid)

    def __enter__(self) -> None:
        """Nothing happens before an error does."""

    def __exit__(
        self, _kind: type[BaseException] | None, error: BaseException | None, _traceback: TracebackType | None
    ) -> None:
        """Name the place in an error."""
        if isinstance(error, InvalidValueError):
            name = self.path if self.exact else (self / error.name).path
            raise InvalidValueError(name, error.value, error.valid) from None
