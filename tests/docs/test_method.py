"""Every section of the method that code or docs refer to is a heading of docs/method.md."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDERS = ("threadstate", "worker", "service", "migrations", "tests", "studies", "benchmarks", "scripts", "examples")
TEXTS = ("*.py", "*.js", "*.md", "*.toml")
OF_THE_PAPER = ("docs/paper-claims.md", "studies/paper/")
"""Where a section is one of the paper unless the method is named."""

OWNER = re.compile(r"\b(method|paper|RFC)\b", re.IGNORECASE)
"""Whose section it is: the last one that the sentence names before."""
MENTION = re.compile(r"\bsections?\s+(\d+(?:\.\d+)*(?:\s*(?:,|and|to)\s*\d+(?:\.\d+)*)*)", re.IGNORECASE)


def sections_mentioned(text: str) -> Iterator[tuple[str, list[str]]]:
    """Who is named before each mention of sections, in the same sentence (or nobody: ``""``), and their numbers."""
    flat = " ".join(re.sub(r"^[ \t]*(?:#|//|\*)?", "", line) for line in text.splitlines())
    for mention in MENTION.finditer(flat):
        owners = OWNER.findall(re.split(r"\.\s", flat[: mention.start()])[-1])
        yield (owners[-1].lower() if owners else ""), re.findall(r"\d+(?:\.\d+)*", mention[1])


def files(root: Path) -> list[Path]:
    """The texts that may refer to the method, this test and the page left out."""
    found = [path for folder in (*FOLDERS, "docs") for kind in TEXTS for path in (root / folder).rglob(kind)]
    left_out = (Path(__file__).resolve(), root / "docs" / "method.md")
    return [root / "README.md", *sorted(path for path in found if path.resolve() not in left_out)]


@pytest.fixture(scope="module")
def headings(repository_root: Path) -> set[str]:
    """The numbers of the page's sections."""
    return set(re.findall(r"^## (\d+)\. ", (repository_root / "docs" / "method.md").read_text(), re.MULTILINE))


def test_sections_are_numbered_from_1(headings: set[str]) -> None:
    assert headings == {str(number) for number in range(1, len(headings) + 1)}


def test_every_section_referred_to_is_there(repository_root: Path, headings: set[str]) -> None:
    referred, missing, unowned = 0, [], []
    for path in files(repository_root):
        name = path.relative_to(repository_root).as_posix()
        for owner, numbers in sections_mentioned(path.read_text()):
            if owner == "method":
                referred += 1
                missing += [f"{name}: method, section {number}" for number in numbers if number not in headings]
            elif not owner and not name.startswith(OF_THE_PAPER):
                unowned.append(f"{name}: section {', '.join(numbers)} of what?")
    assert missing == []
    assert unowned == []
    assert referred > 40


@pytest.mark.parametrize(
    ("text", "mentioned"),
    [
        ("(method, section 12)", [("method", ["12"])]),
        ("the method's\n    section 7, to their digits", [("method", ["7"])]),
        ("(method, sections 1, 3 and 7)", [("method", ["1", "3", "7"])]),
        ("Of the method. The paper, section 6.3, says", [("paper", ["6.3"])]),
        ("The method. As in section 3", [("", ["3"])]),
        ("The HTTP method's default (RFC 9110, section 12.5.3)", [("rfc", ["12.5.3"])]),
    ],
)
def test_mentions_are_found(text: str, mentioned: list[tuple[str, list[str]]]) -> None:
    assert list(sections_mentioned(text)) == mentioned
