"""Every setting with its effective value, without passwords and keys."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from threadstate import settings
from threadstate._numba_cache import SETTING as NUMBA_CACHE_DIR
from threadstate.library.address import database_url, masked_url
from threadstate.thread.catalogue import DEFAULT_DESIGNATION

NOT_SHOWN = "(not shown)"
DEFAULT_SERVICE = "http://127.0.0.1:8000"
_NUMBAS_OWN = "NUMBA_CACHE_DIR"
"""numba's setting, which threadstate sets unless the user has."""


class Source(StrEnum):
    """The source of a value."""

    ENVIRONMENT = "environment"
    DEFAULT = "default"


@dataclass(frozen=True)
class EffectiveSetting:
    """A setting, its value (None: no value) and its source."""

    name: str
    value: str | int | None
    source: Source


def effective_settings(environment: Mapping[str, str] = os.environ) -> tuple[EffectiveSetting, ...]:
    """All settings in their order.

    Raises:
        InvalidValueError: a setting's value is not valid; its name is the environment's.
    """
    read = settings.read_settings(environment)
    service = environment.get(settings.SERVICE) or DEFAULT_SERVICE
    values: dict[str, str | int | None] = {
        settings.DATA_DIR: str(read.data_dir),
        settings.DATABASE: masked_url(database_url(read.database)),
        settings.DATABASE_PASSWORD_FILE: environment.get(settings.DATABASE_PASSWORD_FILE) or None,
        settings.WORKERS: read.workers,
        settings.SCHEDULER: read.scheduler,
        settings.PAIR: read.pair or DEFAULT_DESIGNATION,
        settings.HOST: read.host,
        settings.PORT: read.port,
        settings.READ_KEYS: "required" if read.read_keys_required else "open",
        settings.LEASE_S: read.lease_s,
        settings.HEARTBEAT_FILE: None if read.heartbeat_file is None else str(read.heartbeat_file),
        settings.SERVICE: NOT_SHOWN if "@" in service else service,
        settings.KEY: NOT_SHOWN if environment.get(settings.KEY) else None,
        settings.CACHE_MB: read.cache_mb,
        settings.CONCURRENCY: read.concurrency,
        settings.STREAMS: read.streams,
        settings.TIME_LIMIT_S: read.time_limit_s,
        settings.GRACE_S: read.grace_s,
        settings.LOG: read.log.value,
        settings.LOG_LEVEL: read.log_level.value,
        settings.CORS_ORIGINS: ",".join(read.cors_origins) or None,
        NUMBA_CACHE_DIR: environment.get(NUMBA_CACHE_DIR) or environment.get(_NUMBAS_OWN),
    }
    return tuple(
        EffectiveSetting(name, values[name], Source.ENVIRONMENT if environment.get(name) else Source.DEFAULT)
        for name in settings.NAMES
    )
