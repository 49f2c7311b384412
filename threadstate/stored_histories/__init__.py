"""Stored histories: histories as rows of the tables, and read back from them."""
