"""The stored library: every contact state of a pair over a grid of poses, published when complete."""
