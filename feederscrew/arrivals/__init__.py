"""A virtual drop test: one convex body on one plane, until it rests.

Dimensionless inside: length is the cube root of the hull's volume, gravity and mass are 1.

Source of its laws, steps and launches: docs/resting.md, "The drop test".
"""
