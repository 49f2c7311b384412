"""The published libraries and their inputs."""
