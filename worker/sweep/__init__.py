"""Sweeps: the libraries that a file describes; missing ones are computed."""
