"""What loads do to contact states: of a library's, or of any pose."""
