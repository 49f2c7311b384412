"""The Python interface as pages, made of signatures and docstrings without importing anything.

docs/python.md lists the modules; of each what ``__all__`` names is shown, or all that is public in it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import griffe

PAGE = PurePosixPath("docs/python.md")
FOLDER = PurePosixPath("python")
PACKAGE = "threadstate"
MODULE = re.compile(r"^\| `(threadstate[\w.]*)` \|", re.MULTILINE)

PAGE_NAME = re.compile(r"`{0,2}\bdocs/(?P<page>[\w-]+\.md)`{0,2}")
ROLE = re.compile(r":\w+:`~?([\w.]+)`")
SENDERS = {"_answered": "{}", "_listed": "Items[{}]", "_watched": "Job"}
"""How the client's methods are made of the calls that describe them, and what they return of a call's result."""
TYPE = re.compile(r"\b[A-Z]\w*[a-z]\w*")
RESULT = re.compile(r"^(?:Paged)?Call\[(?P<result>.*)\]$")
WIDTH = 88
"""Of a signature on one line, in characters."""


@dataclass(frozen=True)
class ModulePage:
    """A page of a module: its path in the site, and its Markdown."""

    module: str
    address: PurePosixPath
    text: str


class UndocumentedError(LookupError):
    """A module or a name of the Python interface is not there, or has no docstring."""


def reference_pages(root: Path, page: str) -> list[ModulePage]:
    """The pages of the modules that docs/python.md lists, in its order.

    Raises:
        UndocumentedError: a module or a name is not there, or has no docstring.
    """
    # A relative path would be looked up in the working directory.
    package = griffe.load(
        PACKAGE, search_paths=[root], try_relative_path=False, allow_inspection=False, docstring_parser="google"
    )
    assert isinstance(package, griffe.Module)
    modules = {name: _module(package, name) for name in MODULE.findall(page)}
    shown = {name: list(_shown(module)) for name, module in modules.items()}
    places = {one.canonical_path: name for name, objects in shown.items() for one in objects}
    pages = []
    for name, module in modules.items():
        writer = _Writer(name, places)
        pages.append(ModulePage(name, _address(name), writer.module(module, shown[name])))
    return pages


def _address(module: str) -> PurePosixPath:
    return FOLDER / f"{module}.md"


def _module(package: griffe.Module, name: str) -> griffe.Module:
    try:
        module = package[name.partition(".")[2]] if name != PACKAGE else package
    except KeyError:
        raise UndocumentedError(f"{name}: no such module") from None
    assert isinstance(module, griffe.Module)
    return module


def _shown(module: griffe.Module) -> Iterator[griffe.Object]:
    if module.exports is not None:
        for name in module.exports:
            member = module.members.get(str(name))
            if member is None:
                raise UndocumentedError(f"{module.path}.{name}: no such name")
            yield _target(member)
        return
    for member in module.members.values():
        if not member.is_alias and not member.name.startswith("_") and (member.is_class or member.is_function):
            yield _target(member)


def _target(member: griffe.Object | griffe.Alias) -> griffe.Object:
    return member.final_target if isinstance(member, griffe.Alias) else member


class _Writer:
    """Writes the page of a module; ``places`` says on which module's page a name is shown."""

    def __init__(self, module: str, places: Mapping[str, str]) -> None:
        self._module_name = module
        self._places = places
        named = [(path.rpartition(".")[2], path) for path in places]
        times = Counter(name for name, _ in named)
        self._unique = {name: path for name, path in named if times[name] == 1}

    def module(self, module: griffe.Module, objects: list[griffe.Object]) -> str:
        """The page."""
        parts = [f"# {module.path}", *self._docstring(module)]
        for one in objects:
            parts.append(f"## {one.name} {{ #{one.name} }}")
            if isinstance(one, griffe.Class):
                parts += self._class(one)
            elif isinstance(one, griffe.Function):
                parts += [*self._signed(one.name, one, str(one.returns)), *self._docstring(one)]
            else:
                parts += [_code(f"{one.name}"), *self._docstring(one)]
        return "\n\n".join(parts) + "\n"

    def _class(self, one: griffe.Class) -> Iterator[str]:
        bases = ", ".join(str(base) for base in one.bases)
        yield _code(f"class {one.name}({bases})" if bases else f"class {one.name}")
        yield from self._docstring(one)
        init = one.members.get("__init__")
        if isinstance(init, griffe.Function):
            yield _code(_signature(one.name, init, None))
        members = [
            member
            for name, member in one.members.items()
            if not name.startswith("_") and isinstance(member, griffe.Attribute | griffe.Function)
        ]
        calls = {member.name: described for member in members if (described := _described(member))}
        fields = [member for member in members if isinstance(member, griffe.Attribute) and member.name not in calls]
        properties = [member for member in fields if "property" in member.labels]
        if plain := [member for member in fields if member not in properties]:
            yield self._fields(plain)
        for value in properties:
            yield self._heading(one, value)
            yield _code(f"{value.name}: {value.annotation}")
            yield from self._docstring(value)
        for member in members:
            if member.name in calls:
                function, returned = calls[member.name]
                yield self._heading(one, member)
                yield from self._signed(member.name, function, returned)
                yield from self._docstring(function)
            elif isinstance(member, griffe.Function):
                yield self._heading(one, member)
                yield from self._signed(member.name, member, str(member.returns))
                yield from self._docstring(member)

    def _heading(self, one: griffe.Class, member: griffe.Object) -> str:
        return f"### {one.name}.{member.name} {{ #{one.name}.{member.name} }}"

    def _fields(self, fields: list[griffe.Attribute]) -> str:
        rows = ["| name | type or value | meaning |", "|---|---|---|"]
        for one in fields:
            kind = " = ".join(str(part) for part in (one.annotation, one.value) if part is not None)
            meaning = " ".join(self._text(one, one.docstring.value).split()) if one.docstring else ""
            cells = (f"`{one.name}`", f"`{kind}`" if kind else "", meaning)
            rows.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
        return "\n".join(rows)

    def _signed(self, name: str, function: griffe.Function, returned: str) -> Iterator[str]:
        """A signature, and below it the types in it that are shown."""
        text = _signature(name, function, returned)
        yield _code(text)
        types = dict.fromkeys(TYPE.findall(text.partition("(")[2]))
        if links := [link for one in types if "]" in (link := self._name(function, one))]:
            yield f"Types: {', '.join(links)}"

    def _docstring(self, one: griffe.Object) -> Iterator[str]:
        if one.docstring is None:
            raise UndocumentedError(f"{one.path}: no docstring")
        for section in one.docstring.parsed:
            if isinstance(section, griffe.DocstringSectionText):
                yield self._text(one, section.value)
            elif isinstance(section, griffe.DocstringSectionReturns):
                yield f"**Returns** {' '.join(self._text(one, it.description) for it in section.value)}"
            elif isinstance(section, griffe.DocstringSectionRaises):
                yield "**Raises**"
                yield _list(
                    (self._name(one, str(it.annotation)), self._text(one, it.description)) for it in section.value
                )
            elif isinstance(section, griffe.DocstringSectionParameters | griffe.DocstringSectionAttributes):
                yield f"**{section.kind.value.capitalize()}**"
                yield _list((f"`{it.name}`", self._text(one, it.description)) for it in section.value)
            else:
                raise UndocumentedError(f"{one.path}: a section {section.kind.value}, which is not shown")

    def _text(self, one: griffe.Object, text: str) -> str:
        """A text of an object's docstring, the names and pages in it linked."""
        named = ROLE.sub(lambda found: self._name(one, found[1]), text)
        return PAGE_NAME.sub(r"[\g<page>](../\g<page>)", named)

    def _name(self, one: griffe.Object, name: str) -> str:
        """A name as an object's module means it, linked to where it is shown."""
        path = self._path(one, name)
        if path is None:
            return f"`{name}`"
        module = self._places[path]
        page = "" if module == self._module_name else f"{module}.md"
        return f"[`{name}`]({page}#{path.rpartition('.')[2]})"

    def _path(self, one: griffe.Object, name: str) -> str | None:
        if name in self._places:
            return name
        try:
            resolved = one.resolve(name)
        except griffe.NameResolutionError:
            return self._unique.get(name.rpartition(".")[2])
        return resolved if resolved in self._places else None


def _described(member: griffe.Object) -> tuple[griffe.Function, str] | None:
    """The function that describes a method which is made of a call, and what the method returns."""
    if not isinstance(member, griffe.Attribute) or not isinstance(member.value, griffe.ExprCall):
        return None
    returned = SENDERS.get(str(member.value.function))
    if returned is None:
        return None
    (described,) = member.value.arguments
    assert isinstance(described, griffe.Expr)
    function = member.modules_collection[described.canonical_path]
    assert isinstance(function, griffe.Function)
    result = RESULT.match(str(function.returns))
    assert result, function.path
    return function, returned.format(result["result"])


def _signature(name: str, function: griffe.Function, returned: str | None) -> str:
    parameters, kinds = [], griffe.ParameterKind
    star = False
    for one in function.parameters:
        if one.name == "self":
            continue
        if one.kind is kinds.keyword_only and not star:
            parameters.append("*")
        star = star or one.kind in (kinds.keyword_only, kinds.var_positional)
        prefix = {kinds.var_positional: "*", kinds.var_keyword: "**"}.get(one.kind, "")
        annotation = f": {one.annotation}" if one.annotation is not None else ""
        default = f" = {one.default}" if one.default is not None and not prefix else ""
        parameters.append(f"{prefix}{one.name}{annotation}{default}")
    end = f" -> {returned}" if returned is not None else ""
    line = f"{name}({', '.join(parameters)}){end}"
    if len(line) <= WIDTH:
        return line
    return "\n".join((f"{name}(", *(f"    {one}," for one in parameters), f"){end}"))


def _list(items: Iterable[tuple[str, str]]) -> str:
    return "\n".join(f"- {name}: {' '.join(text.split())}" for name, text in items)


def _code(text: str) -> str:
    return f"```python\n{text}\n```"
