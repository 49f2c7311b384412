"""Computing libraries of settled states."""
