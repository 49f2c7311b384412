"""Samples in files: what is appended is read again, what was cut off is dropped, other inputs are refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.chances.made_up import records
from threadstate.chances.document import record_document, record_from_document, record_sha256, records_sha256
from threadstate.chances.inputs import ChancesInputs
from threadstate.chances.record_file import growing_records, read_records
from threadstate.chances.sampling import Uncertainty
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.thread.catalogue import quarter_twenty_unc

INPUTS = ChancesInputs(quarter_twenty_unc(), default_device(), Strategy.CW, Uncertainty((0.0, 0.0), 1.0, (0.1, 0.2)))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file with two samples, appended by two runs in the order in which they were finished."""
    path = tmp_path / "chances.samples"
    for index in (1, 0):
        with growing_records(path, INPUTS) as (_, append):
            append(records()[index])
    return path


def test_a_record_reads_back_the_same() -> None:
    for one in records():
        document = json.loads(json.dumps(record_document(one)))
        assert record_from_document(document) == one


def test_a_visit_without_readings_or_with_unequal_lists_is_refused() -> None:
    document = json.loads(json.dumps(record_document(records()[0])))
    changes: list[dict[str, list[float]]] = [{"phases": []}, {"phases": [], "torques": [], "forces": []}]
    for lists in changes:
        changed = {**document, "visits": [{**document["visits"][0], **lists}]}
        with pytest.raises(ValueError, match=r"zip|without readings"):
            record_from_document(changed)  # type: ignore[arg-type]


def test_what_is_appended_is_read_by_number(path: Path) -> None:
    assert read_records(path, INPUTS) == records()[:2]


def test_what_a_killed_run_leaves_of_a_line_is_dropped(path: Path) -> None:
    content = path.read_bytes()
    header = content.index(b"\n") + 1
    for length in (0, 1, header - 1, header, header + 40, len(content) - 1, len(content)):
        path.write_bytes(content[:length])
        kept = max(content[:length].count(b"\n") - 1, 0)
        expected = [[], [records()[1]], records()[:2]][kept]
        with growing_records(path, INPUTS) as (known, append):
            assert known == expected
            append(records()[3])
        assert read_records(path, INPUTS) == [*expected, records()[3]]
        assert path.read_bytes().endswith(b"\n")


def test_samples_of_other_inputs_are_refused(path: Path) -> None:
    other = replace(INPUTS, uncertainty=Uncertainty((0.0, 0.0), 1.0, (0.1, 0.3)))
    with pytest.raises(InvalidValueError, match=f"samples of the same inputs and code .{other.sha256[:12]}, not"):
        read_records(path, other)


def test_another_file_and_a_changed_line_are_named(path: Path, tmp_path: Path) -> None:
    (tmp_path / "notes").write_text("notes\n")
    with pytest.raises(InvalidValueError, match="sampled paths, or a file that does not exist"):
        read_records(tmp_path / "notes", INPUTS)
    path.write_bytes(path.read_bytes().replace(b'"torque":0.1', b'"torque":0.2'))
    with pytest.raises(InvalidValueError, match=r"sample file: line 2 is .*valid: a sample with its own hash"):
        read_records(path, INPUTS)


def test_the_content_hash_is_that_of_the_samples_in_any_order() -> None:
    given = records()
    assert records_sha256(given) == records_sha256(given[::-1])
    assert records_sha256(given) != records_sha256(given[:-1])
    assert len({record_sha256(one) for one in given}) == len(given)
