"""Stored settled states: where a bolt comes to rest that a device holds, at every pose of a grid."""
