# Made of _async/__init__.py by `make client`: edit that one.
"""The blocking client, made of ``_async`` by ``make client``."""
