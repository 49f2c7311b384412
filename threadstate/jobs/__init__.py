"""Rebuilds as jobs: what is asked for, who is at it, and what has happened. Nothing here computes."""
