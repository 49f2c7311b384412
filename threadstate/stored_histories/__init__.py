"""Histories in the tables, and back."""
