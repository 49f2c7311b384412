"""The search for a device by success maps."""
