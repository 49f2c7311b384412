"""Chances of assembly on the command line: samples computed by several processes, and what is printed of them."""
