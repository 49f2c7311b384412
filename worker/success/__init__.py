"""Computing success maps."""
