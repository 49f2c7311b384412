"""Answers about published libraries, which do not change: found without making them again."""
