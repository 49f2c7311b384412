"""How far the libraries are that are still being computed."""
