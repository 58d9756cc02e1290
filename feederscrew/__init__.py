"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

Shape letters in every docstring: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a
polygon, N samples, M moments. SI units and radians throughout; ``[1]`` means no unit.
"""

__version__ = "0.1.0"
