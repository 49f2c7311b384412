"""The constraint network: formations, the moves that lead from one to another, and paths and locations in it."""
