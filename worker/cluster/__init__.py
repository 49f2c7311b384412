"""Chunks from the workers of a Dask cluster; the module ``remote`` runs on them."""
