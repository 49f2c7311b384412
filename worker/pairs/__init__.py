"""A pair by its name, from a file, or by its dimensions: for commands, and for the files of sweeps."""
