"""A report of a device: its success map and one path, in words, figures and tables, as one HTML file."""
