"""Chances of assembly under uncertain approach: sampled paths of a device, the network of what holds them, sensing."""
