"""Examples of answers, from real states."""
