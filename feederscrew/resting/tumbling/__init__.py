"""Exact quasi-static tumbling over the facets and edges of a convex hull."""
