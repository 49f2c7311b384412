"""The documentation of the interface, from files that the service itself has."""
