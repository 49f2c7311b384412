"""Paths of bolts that a device settles and turns."""
