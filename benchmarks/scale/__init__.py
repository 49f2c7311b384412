"""What large libraries, and many, cost here: the figures behind docs/scale.md."""
