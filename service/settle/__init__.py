"""Where a bolt comes to rest that a compliant device holds: computed on request."""
