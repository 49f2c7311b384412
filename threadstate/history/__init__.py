"""Histories: the states of an orientation along the phase, cut where a label changes."""
