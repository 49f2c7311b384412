"""Standard threads: sizes, and limits of diameters by tolerance class."""
