"""The service: the stored library and the exact solver over HTTP."""
