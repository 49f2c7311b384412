"""The states of a library: filtered, sorted, page by page, or one by its pose."""
