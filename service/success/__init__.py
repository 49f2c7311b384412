"""Success maps: requested as jobs, and read."""
