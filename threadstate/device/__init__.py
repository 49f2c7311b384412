"""A bolt in a compliant hand: where it rests under a push (docs/device.md)."""
