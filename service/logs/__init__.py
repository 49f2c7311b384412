"""What the process says of itself: one line for each event, on stderr."""
