"""Many libraries by one command: a file says which, those that are not there are computed."""
