"""What a client accepts, and which copy it has: the headers of a conditional, negotiated request."""

from __future__ import annotations


def takes_gzip(accept_encoding: str) -> bool:
    """Whether the header names gzip, or anything, and does not refuse it (``q=0``)."""
    for coding in accept_encoding.lower().split(","):
        name, _, weight = coding.replace(" ", "").partition(";q=")
        if name in ("gzip", "*"):
            return weight.strip("0.") != "" or weight == ""
    return False


def prefers_csv(accept: str) -> bool:
    """Whether the header names text/csv before anything that JSON satisfies."""
    for media_range in accept.split(","):
        match media_range.partition(";")[0].strip().lower():
            case "text/csv":
                return True
            case "application/json" | "application/*" | "*/*":
                return False
    return False


def names_etag(if_none_match: str, etag: str) -> bool:
    """Whether the header's list names ``etag``; for this header RFC 9110 has weak tags match as well."""
    tags = (tag.strip().removeprefix("W/") for tag in if_none_match.split(","))
    return any(tag in (etag, "*") for tag in tags)
