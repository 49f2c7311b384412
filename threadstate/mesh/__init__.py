"""Meshes: bolt and nut as closed triangle solids, and contact states by their collision."""
