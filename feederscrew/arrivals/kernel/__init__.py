"""Compiled motion of one rigid body on one plane."""
