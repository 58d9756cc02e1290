"""A space frame of straight beams: six degrees of freedom a node, Timoshenko's shear, Saint-Venant's twist.

Of nothing in ``feederscrew``: what its closed forms of leaf springs are checked by.
"""

import itertools

import numpy as np


def element(length, section):
    """Stiffness (12, 12) of a beam along its own x, each end with three shifts and three turns.

    ``section``: E A, G A kappa, G J, and E I of bending in its x-y and in its x-z plane; 0 leaves one out.
    """
    stretch, shear, twist, in_xy, in_xz = section
    matrix = np.zeros((12, 12))
    for value, k in ((stretch, 0), (twist, 3)):
        matrix[np.ix_([k, k + 6], [k, k + 6])] = value / length * np.array([[1, -1], [-1, 1]])
    for bend, places, sense in ((in_xy, [1, 5, 7, 11], 1.0), (in_xz, [2, 4, 8, 10], -1.0)):
        phi, a = 12.0 * bend / (shear * length**2), sense * length
        near, far = (4.0 + phi) * a**2, (2.0 - phi) * a**2
        matrix[np.ix_(places, places)] = bend / (length**3 * (1.0 + phi)) * np.array([
            [12, 6 * a, -12, 6 * a], [6 * a, near, -6 * a, far],
            [-12, -6 * a, 12, -6 * a], [6 * a, far, -6 * a, near],
        ])  # fmt: skip
    return matrix


def energy(nodes, across, section, moved):
    """Twice the strain energy of a chain of beams whose first node is held and whose last one is moved.

    Parameters
    ----------
    nodes : (N, 3)
        Along the chain.
    across : (3,)
        A vector in the x-y plane of every beam.
    section
        As of ``element``.
    moved : (6,)
        Shift and turn of the last node.
    """
    size = 6 * len(nodes)
    whole = np.zeros((size, size))
    for k, (begin, end) in enumerate(itertools.pairwise(nodes)):
        along = (end - begin) / np.linalg.norm(end - begin)
        third = np.cross(along, across) / np.linalg.norm(np.cross(along, across))
        axes = np.kron(np.eye(4), np.array([along, np.cross(third, along), third]))
        places = np.arange(6 * k, 6 * k + 12)
        whole[np.ix_(places, places)] += axes.T @ element(np.linalg.norm(end - begin), section) @ axes
    held = [*range(6), *range(size - 6, size)]
    free = np.arange(6, size - 6)
    shifts = np.zeros(size)
    shifts[-6:] = moved
    shifts[free] = -np.linalg.solve(whole[np.ix_(free, free)], whole[np.ix_(free, held)] @ shifts[held])
    return float(shifts @ whole @ shifts)
