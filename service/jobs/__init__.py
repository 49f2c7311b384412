"""Jobs: requested libraries and their progress."""
