"""Jobs: migrating the database, computing libraries, solving on demand; the command line ``threadstate``."""
