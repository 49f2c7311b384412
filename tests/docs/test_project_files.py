"""What stands at the top of the repository beside the README: licence, citation, changelog."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import yaml

import threadstate


def test_the_licence_is_the_one_that_is_declared(repository_root: Path) -> None:
    project = tomllib.loads((repository_root / "pyproject.toml").read_text())["project"]
    citation = yaml.safe_load((repository_root / "CITATION.cff").read_text())
    assert project["license"] == citation["license"] == "Apache-2.0"
    for name in project["license-files"]:
        text = " ".join((repository_root / name).read_text().split())
        assert text.startswith("Apache License Version 2.0, January 2004")
        assert text.endswith("limitations under the License.")


def test_the_citation_names_this_version_and_the_paper(repository_root: Path) -> None:
    citation = yaml.safe_load((repository_root / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    assert citation["version"] == threadstate.__version__
    paper = citation["preferred-citation"]
    assert [author["family-names"] for author in paper["authors"]] == ["Wiedmann", "Sturges"]
    method = " ".join((repository_root / "docs" / "method.md").read_text().split())
    assert f"*{paper['title']}*, J. Mech. Des. {paper['volume']} ({paper['year']})" in method


def test_the_changelog_has_this_version_below_what_is_unreleased(repository_root: Path) -> None:
    changelog = (repository_root / "CHANGELOG.md").read_text()
    versions = re.findall(r"^## \[([^\]]+)\](?: - \d{4}-\d{2}-\d{2})?$", changelog, re.MULTILINE)
    assert versions[:2] == ["Unreleased", threadstate.__version__]
    kinds = set(re.findall(r"^### (.*)$", changelog, re.MULTILINE))
    assert kinds <= {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"}
