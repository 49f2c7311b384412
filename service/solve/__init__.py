"""Poses solved on demand."""
