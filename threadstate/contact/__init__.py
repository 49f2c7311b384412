"""Contacts: where and when the two solids touch along a motion."""
