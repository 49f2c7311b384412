"""Who may use the service: keys, of which the database knows the hashes alone."""
