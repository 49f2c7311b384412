from __future__ import annotations

import pytest

from service.content_negotiation import prefers_csv, prefers_events, takes_gzip


@pytest.mark.parametrize(
    ("header", "taken"),
    [
        ("", False),
        ("gzip", True),
        ("GZIP", True),
        ("x-gzip", True),
        ("*", True),
        ("br, gzip", True),
        ("br", False),
        ("gzip;q=0", False),
        ("gzip;q=0.000", False),
        ("gzip ; Q=0.001", True),
        ("*;q=0", False),
        ("gzip;q=0, *", False),
        ("*, gzip;q=0", False),
        ("*;q=0, gzip", True),
        ("identity;q=1, gzip;q=0.5", False),
        ("gzip;q=0.5, *", False),
        ("gzip;q=0.5, identity;q=0.5", True),
        ("gzip;q=0.5, identity;q=0", True),
        ("gzip;q=0.5, *;q=0", True),
        ("identity", False),
        (",, gzip,", True),
    ],
)
def test_gzip_is_taken_where_it_weighs_at_least_as_much_as_plain_bytes(header: str, taken: bool) -> None:
    """RFC 9110, section 12.5.3."""
    assert takes_gzip(header) is taken


@pytest.mark.parametrize(
    ("header", "preferred"),
    [
        ("", False),
        ("*/*", False),
        ("text/csv", True),
        ("Text/CSV;charset=utf-8", True),
        ("text/*", True),
        ("application/json", False),
        ("text/csv, application/json", True),
        ("application/json, text/csv", False),
        ("text/csv, */*", True),
        ("*/*, text/csv", False),
        ("text/csv;q=0.5, application/json", False),
        ("text/csv;q=0.5, */*;q=0.8", False),
        ("text/csv;q=0.9, */*;q=0.8", True),
        ("application/json;q=0.5, text/csv", True),
        ("application/json;q=0.5, */*", True),
        ("*/*, application/*;q=0.1", True),
        ("text/csv;q=0", False),
        ("text/csv;q=0, text/*", False),
        ("text/html, application/xhtml+xml, application/xml;q=0.9, */*;q=0.8", False),
    ],
)
def test_csv_is_preferred_where_it_weighs_more_or_is_named_first(header: str, preferred: bool) -> None:
    """RFC 9110, section 12.5.1: the most specific range that fits a type gives its weight."""
    assert prefers_csv(header) is preferred


@pytest.mark.parametrize("weight", ["", "x", "-1", "2", "1.5", "0.1234", "1_0", "٣", "nan", "0,5", "1;q=0"])
def test_a_weight_that_is_none_makes_its_member_worth_nothing(weight: str) -> None:
    assert not takes_gzip(f"gzip;q={weight}")
    assert not prefers_csv(f"text/csv;q={weight}")
    assert takes_gzip(f"br;q={weight}, gzip")


@pytest.mark.parametrize(
    ("header", "preferred"),
    [
        ("", False),
        ("*/*", False),
        ("text/*", False),
        ("text/event-stream", True),
        ("Text/Event-Stream;q=0.5", True),
        ("text/event-stream, application/json", True),
        ("application/json, text/event-stream", False),
        ("text/event-stream;q=0.5, */*", False),
        ("application/json;q=0.5, text/event-stream", True),
        ("text/event-stream;q=0", False),
    ],
)
def test_events_are_preferred_where_they_are_named_and_weigh_more_or_come_first(header: str, preferred: bool) -> None:
    assert prefers_events(header) is preferred
