"""The requests of the interface, one file per resource; both clients send these."""
