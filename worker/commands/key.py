"""``threadstate key``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from threadstate.access.scope import Scope
from threadstate.errors import InvalidValueError
from threadstate.settings import read_settings
from worker.options import Database, Json
from worker.output import print_json, print_line, print_status


class Action(StrEnum):
    """What is done with keys."""

    CREATE = "create"
    LIST = "list"
    REVOKE = "revoke"


def key(
    action: Annotated[Action, typer.Argument(help="What to do.", show_default=False)],
    database: Database = None,
    name: Annotated[str | None, typer.Option("--name", metavar="TEXT", help="create: whose it is.")] = None,
    scope: Annotated[Scope, typer.Option("--scope", help="create: what it permits.")] = Scope.WRITE,
    key_id: Annotated[str | None, typer.Option("--id", metavar="ID", help="revoke: which one, by its id.")] = None,
    as_json: Json = False,
) -> None:
    r"""Create, list or revoke the keys of the service.

    A key is printed when it is created and never again: the database has its hash alone.

    \b
    Examples:
      threadstate key create --name designer
      threadstate key create --name reader --scope read
      threadstate key list
      threadstate key revoke --id 0123456789ab
    """
    from threadstate.access.keys import create_key, keys, revoke_key
    from threadstate.library.engine import writing
    from threadstate.library.schema import check_schema

    with writing(database or read_settings().database) as engine:
        check_schema(engine)
        match action:
            case Action.CREATE:
                made = create_key(engine, _required("--name", name), scope)
                print_status("This is the key; it is shown this once.")
                if as_json:
                    print_json({"key": made})
                else:
                    print_line(made)
            case Action.REVOKE:
                revoked = _required("--id", key_id)
                revoke_key(engine, revoked)
                if as_json:
                    print_json({"revoked": revoked})
                else:
                    print_line(f"key {revoked} is revoked")
            case Action.LIST:
                with engine.connect() as connection:
                    for one in keys(connection):
                        ended = one.revoked_at and one.revoked_at.isoformat()
                        if as_json:
                            described = {"id": one.id, "name": one.name, "scope": one.scope.value}
                            print_json({**described, "created_at": one.created_at.isoformat(), "revoked_at": ended})
                        else:
                            print_line(f"{one.id}  {one.scope}  {f'revoked {ended}' if ended else 'valid'}  {one.name}")


def _required(option: str, value: str | None) -> str:
    if value is None:
        raise InvalidValueError(option, value, "given")
    return value
