"""Stored settled states: where a bolt comes to rest that a device holds, at the poses of a grid."""
