"""Bolt and nut as meshes, to be looked at."""
