"""Shapes and numbers without physics: vectors, polygons, solid angles, and the one door to numba."""
