"""The asynchronous client; ``make client`` makes the blocking one, ``_sync``, of these files."""
