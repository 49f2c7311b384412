"""The command line ``threadstate`` and the workers: migrating databases, computing libraries, solving poses."""
