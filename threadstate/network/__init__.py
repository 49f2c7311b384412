"""The constraint network: formations, the moves that lead from one to another, and what follows from them."""
