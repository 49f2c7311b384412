"""The orientations of a library, summed up over all phases."""
