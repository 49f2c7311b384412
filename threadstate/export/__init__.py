"""A library's tables as rows and columns, and these as files, in memory that does not grow with the library."""
