"""The constraint network of a library: transitions, windows, formations, paths, locations."""
