"""A library as a file."""
