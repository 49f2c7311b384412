"""The explorer: an interactive page over the interface."""
