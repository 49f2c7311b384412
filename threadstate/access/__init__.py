"""API keys, of which the database stores the hashes alone."""
