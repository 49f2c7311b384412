"""The service describes itself, with nothing from elsewhere."""
