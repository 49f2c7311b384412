"""How much one process takes on: the size of a body, how many compute at once, and for how long."""
