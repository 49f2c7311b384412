"""Histories: what an orientation goes through as its phase turns, cut where anything changes."""
