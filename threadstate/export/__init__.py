"""Exports: a library's tables as files, written in constant memory."""
