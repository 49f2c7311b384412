"""What every request meets first and every answer last: its number, its line in the log, its count, its headers."""
