"""What methods of both clients take over from the function that describes their request."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any


def describe_as(method: Callable[..., Any], describe: Callable[..., Any], returned: str = "{}") -> None:
    """Give a method the name and the documentation of ``describe``, and its parameters behind the client.

    ``returned`` is what the method returns, with ``{}`` for what the described request is answered by.
    """
    method.__name__ = describe.__name__
    method.__doc__ = describe.__doc__
    signature = inspect.signature(describe)
    client = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    answer = str(signature.return_annotation).removeprefix("Paged").removeprefix("Call[").removesuffix("]")
    method.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[client, *signature.parameters.values()], return_annotation=returned.format(answer)
    )
