"""The files of the explorer's page; what the page does is in tests/explorer."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from service.explorer.endpoints import page
from service.page_files import HTML
from service.problems import MEDIA_TYPE

pytestmark = pytest.mark.sqlite_alone

LARGEST_PAGE_BYTES = 1_000_000


def test_every_file_is_served_for_good_and_compressed_where_that_is_taken(client: TestClient) -> None:
    for name, file in page().files.items():
        path = f"/explorer/{page().version}/{name}"
        plain = client.get(path, headers={"Accept-Encoding": "identity"})
        assert plain.status_code == 200, name
        assert plain.content == file.content
        assert plain.headers["Content-Type"] == file.media_type
        assert plain.headers["Cache-Control"] == "public, max-age=31536000, immutable"
        assert plain.headers["Vary"] == "Accept-Encoding"
        zipped = client.get(path, headers={"Accept-Encoding": "gzip"})
        assert zipped.headers["Content-Encoding"] == "gzip"
        assert zipped.content == file.content
        assert zipped.headers["ETag"] != plain.headers["ETag"]


@pytest.mark.parametrize(
    ("accepted", "zipped"),
    [
        ("gzip", True),
        ("br, gzip;q=0.5", True),
        ("*", True),
        ("GZIP; q=1", True),
        ("", False),
        ("br", False),
        ("gzip;q=0", False),
        ("gzip; q=0.000, br", False),
        ("identity", False),
    ],
)
def test_compression_follows_the_header(client: TestClient, accepted: str, zipped: bool) -> None:
    headers = client.get("/", headers={"Accept-Encoding": accepted}).headers
    assert (headers.get("Content-Encoding") == "gzip") is zipped


def test_page_names_files_that_there_are(client: TestClient) -> None:
    names = re.findall(r'(?:src|href)="/explorer/([^"/]+)/([^"]+)"', client.get("/").text)
    assert len(names) > 4
    assert {version for version, _ in names} == {page().version}
    assert {name for _, name in names} <= set(page().files)


def test_the_picture_of_the_axes_is_that_of_the_documents(repository_root: Path) -> None:
    assert page().files["axes.svg"].content == (repository_root / "docs/axes.svg").read_bytes()


def test_modules_import_files_that_there_are() -> None:
    for name, file in page().files.items():
        if name.startswith("js/"):
            for imported in re.findall(r'(?:from |import\()"(\.[^"]+)"', file.content.decode()):
                folder = "third-party" if imported.startswith("../third-party/") else "js"
                assert f"{folder}/{imported.rpartition('/')[2]}" in page().files, (name, imported)


def test_no_file_is_served_under_another_version_or_from_elsewhere(client: TestClient) -> None:
    version = page().version
    for path in (f"/explorer/0{version[1:]}x/index.html", f"/explorer/{version}/../files.py"):
        assert client.get(path).status_code == 404
    assert client.get(f"/explorer/{version}/%2e%2e%2ffiles.py").status_code == 404


def test_all_files_together_are_small() -> None:
    files = page().files.values()
    assert all(gzip.decompress(file.zipped) == file.content for file in files)
    assert sum(len(file.zipped) for file in files) < LARGEST_PAGE_BYTES


def test_a_browser_gets_a_page_for_an_unknown_address_and_a_program_a_problem(client: TestClient) -> None:
    browser = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"}
    for path in ("/nowhere", "/v1", "/docs/assets/x/y"):
        response = client.get(path, headers=browser)
        assert (response.status_code, response.headers["Content-Type"]) == (404, HTML)
        assert client.get(path).headers["Content-Type"] == MEDIA_TYPE
    for path in ("/v1/nowhere", "/v1/libraries/999"):
        assert client.get(path, headers=browser).headers["Content-Type"] == MEDIA_TYPE
