"""The poses that a library's method could not decide."""
