"""Examples of responses, from real states."""
