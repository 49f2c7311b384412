"""Responses about published libraries, which do not change: cached in memory, or read straight from the database."""
