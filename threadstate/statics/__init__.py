"""Statics: what a contact state holds, how it wedges, and what turns it (docs/forces.md)."""
