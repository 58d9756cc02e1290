"""Where the sides of a foot cross the edges of a hole that passes below it.

Polar about the bowl's axis: theta counter-clockwise from the foot of the centre of mass, r from the axis.
A hole's edge is theta = alpha + kappa r + asin(gamma / r) between two radii, or an arc of one radius; the
hole is shifted by phi, which falls as the part advances. On a stretch of a side over which the shift of its
crossing with an edge is monotone, the crossing exists while phi is between the shifts of its two ends.
"""

import math

from feederscrew.geometry.compiled import compiled, record_type

STRETCH = record_type("side", "edge", "t0", "t1", "phi0", "phi1", whole=("side", "edge"))  # of a side
CUTS = 10  # at most that many ends of stretches on a side
SHORT_SIDE = 1e-13  # [1] of a side
TINY = 1e-300


@compiled
def shift(side, edge, t):
    """Return the shift [rad] at which an edge crosses a side at share ``t`` of its length.

    Source: the edge's equation in polar coordinates, as in the head of the module.
    """
    x, q = side[0] + t * side[2], side[1] + t * side[3]
    radius = math.hypot(x, q)
    bend = 0.0 if edge.gamma == 0.0 else math.asin(min(edge.gamma / radius, 1.0))
    return math.atan2(x, q) - edge.alpha - edge.kappa * radius - bend


@compiled
def sort(values, count):
    """Sort the first values of an array in place (Shell, with Ciura's gaps)."""
    for gap in (1750, 701, 301, 132, 57, 23, 10, 4, 1):
        for i in range(gap, count):
            value, k = values[i], i - gap
            while k >= 0 and values[k] > value:
                values[k + gap] = values[k]
                k -= gap
            values[k + gap] = value


@compiled
def stretches(sides, edges, out, cuts):
    """Fill the stretches of every side with every edge.

    Source: own; docs/tooling.md, "1. The method": where an edge of the hole meets the foot.

    Parameters
    ----------
    sides : (E, 4) float [m]
        Start and vector of each side of the foot, x ahead and q away from the bowl's axis.
    edges : (M,) `tooling.devices.openings.HOLE_EDGE`
    out : (N,) STRETCH
        To be filled; no more than it holds are kept.
    cuts : (CUTS,) float [1]
        Scratch.

    Returns
    -------
    int
        How many there are.
    """
    count = 0
    for k in range(len(sides)):
        for j in range(len(edges)):
            if edges[j].arc:
                count = _on_arc(sides[k], edges[j], k, j, out, count)
            else:
                count = _on_slant(sides[k], edges[j], k, j, out, count, cuts)
    return count


@compiled
def _at_radius(side, radius, cuts, number):
    """Add the shares of a side at which it crosses a circle about the axis."""
    a = side[2] * side[2] + side[3] * side[3]
    nearest = -(side[0] * side[2] + side[1] * side[3]) / a
    cx, cq = side[0] + nearest * side[2], side[1] + nearest * side[3]
    low = math.hypot(cx, cq)
    if radius <= low:
        return number
    half = math.sqrt((radius - low) * (radius + low) / a)
    for share in (nearest - half, nearest + half):
        if 0.0 < share < 1.0:
            cuts[number] = share
            number += 1
    return number


@compiled
def _on_arc(side, edge, k, j, out, count):
    cuts = (-1.0, -1.0)
    a = side[2] * side[2] + side[3] * side[3]
    nearest = -(side[0] * side[2] + side[1] * side[3]) / a
    low = math.hypot(side[0] + nearest * side[2], side[1] + nearest * side[3])
    if edge.low > low:
        half = math.sqrt((edge.low - low) * (edge.low + low) / a)
        cuts = (nearest - half, nearest + half)
    for t in cuts:
        if 0.0 <= t <= 1.0 and count < len(out):
            theta = math.atan2(side[0] + t * side[2], side[1] + t * side[3])
            _keep(out[count], k, j, t, t, theta - edge.kappa, theta - edge.alpha)
            count += 1
    return count


@compiled
def _on_slant(side, edge, k, j, out, count, cuts):
    if _beyond(side, edge):
        return count
    cuts[0], cuts[1] = 0.0, 1.0
    number = _at_radius(side, edge.low, cuts, 2)
    number = _at_radius(side, edge.high, cuts, number)
    number = _turning(side, edge, cuts, number)
    sort(cuts, number)
    for i in range(number - 1):
        t0, t1 = cuts[i], cuts[i + 1]
        if t1 - t0 < SHORT_SIDE or count >= len(out):
            continue
        middle = 0.5 * (t0 + t1)
        radius = math.hypot(side[0] + middle * side[2], side[1] + middle * side[3])
        if edge.low <= radius <= edge.high:
            _keep(out[count], k, j, t0, t1, shift(side, edge, t0), shift(side, edge, t1))
            count += 1
    return count


@compiled
def _beyond(side, edge):
    """Whether a side lies outside the ring of an edge's radii for certain."""
    first = side[0] * side[0] + side[1] * side[1]
    x, q = side[0] + side[2], side[1] + side[3]
    if max(first, x * x + q * q) < edge.low * edge.low:
        return True
    a = side[2] * side[2] + side[3] * side[3]
    nearest = min(max(-(side[0] * side[2] + side[1] * side[3]) / a, 0.0), 1.0)
    return math.hypot(side[0] + nearest * side[2], side[1] + nearest * side[3]) > edge.high


@compiled
def _turning(side, edge, cuts, number):
    """Add the shares at which the distance from the axis is least and at which an edge touches a side."""
    a = side[2] * side[2] + side[3] * side[3]
    nearest = -(side[0] * side[2] + side[1] * side[3]) / a
    if 0.0 < nearest < 1.0:
        cuts[number] = nearest
        number += 1
    if edge.kappa == 0.0:
        return number
    moment = side[2] * side[1] - side[0] * side[3]  # d theta / dt = moment / r^2
    height2, pull2 = moment * moment / a, (moment / edge.kappa) ** 2
    # kappa^2 (p v)^2 r^2 = moment^2, with p v = a tau and r^2 = height2 + a tau^2
    b = a * a * height2
    z = 2.0 * pull2 / max(b + math.sqrt(b * b + 4.0 * a * a * a * pull2), TINY)
    share = nearest + math.copysign(math.sqrt(z), moment / edge.kappa)
    if 0.0 < share < 1.0:
        cuts[number] = share
        number += 1
    return number


@compiled
def _keep(row, k, j, t0, t1, phi0, phi1):
    row.side, row.edge, row.t0, row.t1, row.phi0, row.phi1 = k, j, t0, t1, phi0, phi1


@compiled
def place(side, edge, row, phi):
    """Return the share [1] of a side at which an edge shifted by ``phi`` [rad] crosses it, on one stretch."""
    low, high = row.t0, row.t1
    if low == high:
        return low
    below, above = row.phi0 - phi, row.phi1 - phi
    if below == 0.0 or above == 0.0 or (below > 0.0) == (above > 0.0):
        return low if abs(below) <= abs(above) else high
    t = low - below * (high - low) / (above - below)
    for _ in range(60):
        value = shift(side, edge, t) - phi
        low, high = (t, high) if (value > 0.0) == (below > 0.0) else (low, t)
        slope = _slope(side, edge, t)
        step = -value / slope if slope != 0.0 else 0.0
        if abs(step) < SHORT_SIDE and slope != 0.0:
            return min(max(t + step, low), high)
        t = t + step if low < t + step < high and slope != 0.0 else 0.5 * (low + high)
        if high - low < SHORT_SIDE:
            return t
    return t


@compiled
def _slope(side, edge, t):
    """Derivative of ``shift`` [rad] by the share of the side."""
    x, q = side[0] + t * side[2], side[1] + t * side[3]
    radius2 = x * x + q * q
    outward, radius = x * side[2] + q * side[3], math.sqrt(radius2)
    slope = (side[2] * q - side[3] * x) / radius2 - edge.kappa * outward / radius
    if edge.gamma == 0.0:
        return slope
    return slope + edge.gamma * outward / (radius2 * math.sqrt(max(radius2 - edge.gamma**2, TINY)))
