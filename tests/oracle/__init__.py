"""Brute force, written from the method page alone: what the exact solver is tested against.

Nothing here imports the solver. The only things shared with it are the pair's dimensions.
"""
