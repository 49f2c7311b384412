"""API keys: created and printed once, stored as hashes, compared in constant time."""

from __future__ import annotations

import hashlib
import hmac
import re
import secrets
from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import Connection, Engine, insert, select, update

from threadstate.access.scope import Scope
from threadstate.access.tables import KEY_ID_LENGTH, KEY_NAME_LENGTH, api_key
from threadstate.errors import InvalidValueError, NotFoundError, ThreadstateError

SECRET_BYTES = 32
_KEY = re.compile(rf"ts_([0-9a-f]{{{KEY_ID_LENGTH}}})_[A-Za-z0-9_-]{{43}}", re.ASCII)


class KeyRefusedError(ThreadstateError):
    """The request has no valid API key; the message does not repeat the one it has."""


class ScopeRefusedError(ThreadstateError):
    """The API key is valid, but its scope does not permit the request."""


@dataclass(frozen=True)
class KeyRecord:
    """A key without its secret."""

    id: str
    name: str
    scope: Scope
    created_at: datetime
    revoked_at: datetime | None


def create_key(engine: Engine, name: str, scope: Scope) -> str:
    """Create a key; the database stores its hash alone.

    Returns:
        The key, which cannot be read again.

    Raises:
        InvalidValueError: the name is empty or too long.
    """
    if not 1 <= len(name) <= KEY_NAME_LENGTH or not name.isprintable():
        raise InvalidValueError("name", name, f"1 to {KEY_NAME_LENGTH} printable characters")
    key_id = secrets.token_hex(KEY_ID_LENGTH // 2)
    key = f"ts_{key_id}_{secrets.token_urlsafe(SECRET_BYTES)}"
    with engine.begin() as connection:
        connection.execute(
            insert(api_key).values(
                id=key_id, name=name, scope=scope.value, sha256=_sha256(key), created_at=datetime.now(UTC)
            )
        )
    return key


def keys(connection: Connection) -> list[KeyRecord]:
    """All keys, revoked ones too, the oldest first."""
    rows = connection.execute(select(api_key).order_by(api_key.c.created_at, api_key.c.id))
    return [KeyRecord(row.id, row.name, Scope(row.scope), row.created_at, row.revoked_at) for row in rows]


def revoke_key(engine: Engine, key_id: str) -> None:
    """Revoke a key from the next request on; has no effect on a revoked key.

    Raises:
        NotFoundError: no key has that id.
    """
    with engine.begin() as connection:
        found = connection.execute(select(api_key.c.revoked_at).where(api_key.c.id == key_id)).first()
        if found is None:
            raise NotFoundError(f"there is no key {key_id}; `threadstate key list` shows their ids")
        if found.revoked_at is None:
            connection.execute(update(api_key).where(api_key.c.id == key_id).values(revoked_at=datetime.now(UTC)))


def require_key(connection: Connection, key: str | None, scope: Scope) -> None:
    """Check the key of a request.

    Raises:
        KeyRefusedError: the key is missing, unknown or revoked.
        ScopeRefusedError: the key is for reading alone, and ``scope`` is writing.
    """
    shape = _KEY.fullmatch(key or "")
    row = None
    if shape is not None:
        row = connection.execute(select(api_key).where(api_key.c.id == shape[1])).first()
    # An unknown id takes as long as a wrong secret.
    expected = "0" * 64 if row is None else row.sha256
    matches = hmac.compare_digest(_sha256(key or ""), expected)
    if row is None or not matches or row.revoked_at is not None:
        raise KeyRefusedError("a valid API key is needed: `Authorization: Bearer KEY`")
    if scope is Scope.WRITE and Scope(row.scope) is not Scope.WRITE:
        raise ScopeRefusedError("this key is for reading alone")


def _sha256(key: str) -> str:
    return hashlib.sha256(key.encode("utf-8", "replace")).hexdigest()
