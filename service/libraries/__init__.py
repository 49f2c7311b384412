"""The libraries: what is published, and what it was computed from."""
