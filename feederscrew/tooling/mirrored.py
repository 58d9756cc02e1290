"""Which orientations are mirror images of each other, fore and aft."""

from dataclasses import replace

from feederscrew.mechanics.wall import sameness


def named(found):
    """Return orientations with the names of their mirror images, fore and aft.

    Parameters
    ----------
    found : sequence of Orientation

    Returns
    -------
    tuple of Orientation
    """
    looks = [_look(one) for one in found]
    pairs = {}
    for i in range(len(found)):
        for j in range(len(found)):
            near = abs(found[i].length - found[j].length) < 1e-2 * found[i].length
            if i != j and near and sameness.looks_alike(looks[i], looks[j], mirrored=True):
                pairs[i] = found[j].name
    return tuple(replace(one, mirror=pairs.get(k, "")) for k, one in enumerate(found))


def _look(one):
    supports, moments = sameness.looks(one.posture, [one.heading])
    return supports[0], None if moments is None else moments[0]
