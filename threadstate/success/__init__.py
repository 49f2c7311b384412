"""Success maps: from which orientations, starting phases and frictions a device and a strategy assemble a pair."""
