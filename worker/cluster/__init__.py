"""Chunks from the workers of a Dask cluster; what ends in ``remote`` or below it runs there."""
