"""A constant of the contact kernels has one value: a name that two modules share is the same thing."""

from __future__ import annotations

import importlib
import pkgutil
from collections import defaultdict

import threadstate.contact


def test_no_constant_has_two_values() -> None:
    values: dict[str, dict[str, object]] = defaultdict(dict)
    for module in pkgutil.iter_modules(threadstate.contact.__path__):
        for name, value in vars(importlib.import_module(f"threadstate.contact.{module.name}")).items():
            if name.isupper() and isinstance(value, (int, float, tuple)):
                values[name][module.name] = value
    assert len(values) > 200
    assert {name: where for name, where in values.items() if len(set(where.values())) > 1} == {}
