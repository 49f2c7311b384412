"""The history of an orientation: its states at all phases, in order."""
