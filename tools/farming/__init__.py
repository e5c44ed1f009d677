"""Renders on a Dask cluster, for tools/farm: the command line and what workers run are in farm.py."""
