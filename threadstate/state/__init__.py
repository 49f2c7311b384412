"""States: the three stages of a pose, its contacts, its class."""
