"""SQL is made of bound parameters and fixed text alone: no value is ever written into a statement."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOMS = ("threadstate", "worker", "service")
TAKES_SQL = {
    "text",
    "execute",
    "executemany",
    "executescript",
    "exec_driver_sql",
    "scalar",
    "scalars",
    "literal_column",
}
BUILDS_TEXT = {"format", "join", "replace", "format_map"}

CHECKED_TEXT = {
    # The cache's size and the checkpoint's pages: constants of the file itself.
    "threadstate/library/engine.py": {
        "PRAGMA cache_size = -{WRITER_CACHE_KIB}",
        "PRAGMA wal_autocheckpoint = {WRITER_CHECKPOINT_PAGES}",
        # Names and values of session parameters, written in the file itself; SET takes no bound ones.
        "SET {name} = '{value}'",
    },
    # What SQLAlchemy compiles of a table: names alone, with a placeholder for every value.
    "threadstate/library/write.py": {"str(insert(table).compile(dialect=dialect))"},
}
"""Statements that are built nonetheless, each with the reason why nothing of a user's can be in them."""


def _calls(tree: ast.AST) -> Iterator[ast.Call]:
    others = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and not (node.module or "").startswith("sqlalchemy")
        for alias in node.names
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name in TAKES_SQL and node.args and not (isinstance(node.func, ast.Name) and name in others):
                yield node


def _is_built(node: ast.expr) -> bool:
    """Whether an expression is text put together: an f-string, a sum, ``%``, ``format`` or ``join``."""
    if isinstance(node, ast.JoinedStr):
        return any(isinstance(part, ast.FormattedValue) for part in node.values)
    if isinstance(node, ast.BinOp):
        return isinstance(node.op, ast.Add | ast.Mod) and any(_is_text(one) for one in (node.left, node.right))
    return isinstance(node, ast.Call) and (
        (isinstance(node.func, ast.Attribute) and node.func.attr in BUILDS_TEXT)
        or (isinstance(node.func, ast.Name) and node.func.id == "str")
    )


def _is_text(node: ast.expr) -> bool:
    return (isinstance(node, ast.Constant) and isinstance(node.value, str)) or _is_built(node)


def _shown(node: ast.expr) -> str:
    shown = ast.unparse(node)
    return shown[2:-1] if isinstance(node, ast.JoinedStr) else shown


def built_statements(source: str) -> set[str]:
    """The texts, put together at run time, that reach something that takes SQL: directly or through a name."""
    tree = ast.parse(source)
    named: dict[str, ast.expr] = {}
    returned: dict[str, ast.expr] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            named[node.targets[0].id] = node.value
        if isinstance(node, ast.FunctionDef):
            for inner in ast.walk(node):
                if isinstance(inner, ast.Return) and inner.value is not None:
                    returned[node.name] = inner.value
    found = set()
    for call in _calls(tree):
        value: ast.expr | None = call.args[0]
        if isinstance(value, ast.Name):
            value = named.get(value.id)
        if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in returned:
            value = returned[value.func.id]
        if value is not None and _is_built(value):
            found.add(_shown(value))
    return found


def test_no_statement_is_put_together_but_those_that_are_known(repository_root: Path) -> None:
    found = {
        path.relative_to(repository_root).as_posix(): statements
        for room in ROOMS
        for path in (repository_root / room).rglob("*.py")
        if (statements := built_statements(path.read_text()))
    }
    assert found == CHECKED_TEXT


def test_a_statement_that_is_put_together_is_found() -> None:
    for source in (
        'c.execute(text(f"SELECT {x}"))',
        'c.execute("SELECT " + x)',
        'c.exec_driver_sql("SELECT %s" % x)',
        'c.scalar(text("SELECT {}".format(x)))',
        'q = "SELECT " + x\nc.execute(q)',
        'def sql(x):\n    return f"SELECT {x}"\nc.execute(sql(1))',
        'q = ",".join(x)\nc.scalars(q)',
    ):
        assert built_statements(source), source
    assert not built_statements('c.execute(text("SELECT 1"))\nq = select(a).where(a == x)\nc.execute(q)')
