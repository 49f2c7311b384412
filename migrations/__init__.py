"""The migrations of the database, run by ``threadstate migrate``."""
