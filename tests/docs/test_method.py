"""Every section that code or docs refer to is a heading of docs/method.md, docs/forces.md or docs/certificate.md."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDERS = ("threadstate", "worker", "service", "migrations", "tests", "studies", "benchmarks", "scripts", "examples")
TEXTS = ("*.py", "*.js", "*.md", "*.toml")
OF_THE_PAPER = ("docs/paper-claims.md", "studies/paper/")
"""Where a section is one of the paper unless the method is named."""

OWNERS = ("method", "forces", "certificate")
"""The pages that define quantities or derive bounds."""
OWNER = re.compile(r"\b(method|forces|certificate|paper|RFC)\b", re.IGNORECASE)
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
    left_out = (Path(__file__).resolve(), *(root / "docs" / f"{owner}.md" for owner in OWNERS))
    return [root / "README.md", *sorted(path for path in found if path.resolve() not in left_out)]


@pytest.fixture(scope="module")
def headings(repository_root: Path) -> dict[str, set[str]]:
    """The numbers of each page's sections."""
    pages = {owner: (repository_root / "docs" / f"{owner}.md").read_text() for owner in OWNERS}
    return {owner: set(re.findall(r"^## (\d+)\. ", page, re.MULTILINE)) for owner, page in pages.items()}


def test_sections_are_numbered_from_1(headings: dict[str, set[str]]) -> None:
    for numbers in headings.values():
        assert numbers == {str(number) for number in range(1, len(numbers) + 1)}


def test_every_section_referred_to_is_there(repository_root: Path, headings: dict[str, set[str]]) -> None:
    referred, missing, unowned = dict.fromkeys(OWNERS, 0), [], []
    for path in files(repository_root):
        name = path.relative_to(repository_root).as_posix()
        for owner, numbers in sections_mentioned(path.read_text()):
            if owner in OWNERS:
                referred[owner] += 1
                missing += [f"{name}: {owner}, section {number}" for number in numbers if number not in headings[owner]]
            elif not owner and not name.startswith(OF_THE_PAPER):
                unowned.append(f"{name}: section {', '.join(numbers)} of what?")
    assert missing == []
    assert unowned == []
    assert referred["method"] > 40
    assert referred["forces"] > 0
    assert referred["certificate"] > 0


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
