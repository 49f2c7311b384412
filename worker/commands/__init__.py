"""One file a command. Slow imports are made when a command runs, so that ``--help`` is fast."""
