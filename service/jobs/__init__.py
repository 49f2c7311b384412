"""Libraries that are asked for, and how far they are."""
