"""One file a command. What is slow to import is imported when its command runs: ``--help`` is to be quick."""
