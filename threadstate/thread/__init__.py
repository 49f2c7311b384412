"""Threads: profile, form, fit and pair."""
