"""Many parts on one vibrating plate, on several cores."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import falling
from feederscrew.dropping.kernel import ride as shaken
from feederscrew.dropping.pool import in_batches
from feederscrew.geometry.compiled import on_disk

BATCH = 10  # parts a core takes at a time


@dataclass(frozen=True, eq=False)
class Rides:
    """Where each of N parts lay at each of K looks."""

    faces: np.ndarray  # (N, K) face it lies on, UNSETTLED while it may be tipping over
    places: np.ndarray  # (N, K, 2) of its centre of mass, in units of L
    lost: int  # further parts, left out: their motion took far more steps than it should
    partial: bool  # stopped by the user before all were done


def ride(shape, floor, starts, looks, steps, *, kick=math.inf, jobs=1, progress=None):
    """Follow parts on a plate.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    shape : Shape
    floor : Floor
    starts : feederscrew.dropping.launches.Starts
        Of the N parts, relative to the plate.
    looks : (K,) float [sqrt(L/g)]
        Times, ascending.
    steps : Steps
    kick : float [m g L]
        Energy that the floor gives a part at most: one whose face it does not tip it off is followed no
        further. Infinite, all parts are followed to the end.
    jobs : int
        Cores to use; the outcome does not depend on it.
    progress : function, optional
        Told after every batch how many parts are done.

    Returns
    -------
    Rides
        After an interrupt from the keyboard, the batches that were finished, up to the first that was not:
        a run of so many parts gives the same.

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    batch = partial(_batch, shape, floor, starts, looks, steps, kick)
    batch(slice(0, 0))  # compiled here, if need be
    columns, stopped = in_batches(batch, len(starts.energies), BATCH, jobs, progress)
    faces, places, whole = columns
    return Rides(check.frozen(faces[whole]), check.frozen(places[whole]), int((~whole).sum()), stopped)


def joined(rides):
    """Return several rides, one after the other, as one."""
    return Rides(
        faces=check.frozen(np.concatenate([one.faces for one in rides])),
        places=check.frozen(np.concatenate([one.places for one in rides])),
        lost=sum(one.lost for one in rides),
        partial=any(one.partial for one in rides),
    )


def compiled():
    """Tell whether the kernel of the plate is on disk already."""
    return on_disk(shaken.ride_all)


def _batch(shape, floor, starts, looks, steps, kick, part):
    """Faces and places of some parts, and whether every look was taken."""
    launched = starts.launched(part)
    seen = shaken.unseen(len(launched.states), looks)
    shaken.ride_all(shape, falling.scratch(shape), floor, launched, steps, seen, kick)
    return seen.faces, seen.places, seen.taken == len(looks)
