"""Arrays for the parts on a stretch of track, which the kernel works in."""

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.trial.kernel import contact, supports, travel
from feederscrew.trial.kernel.crowd_records import LISTS, Crowd, Limits, Sent, Together
from feederscrew.trial.kernel.near_borders import BLOCK

CONTACTS = 96  # of a part with the track at a time
PAIRS = 400  # contacts between parts at a time
NEAR = 4000  # edges near borders at a time, and faces near their corners
SIDES = 12  # borders near a corner, in the mean
ALONE = Together(active=np.zeros(0, bool), time=0.0, steps=0, notes=np.zeros(travel.NOTES + 2))
NOBODY = Sent(
    states=np.zeros((0, body.STATE)), times=np.zeros(0), every=1, paths=np.zeros((0, 0, 8)),
    notes=np.zeros((0, travel.NOTES + 2)), outcomes=np.zeros(0, np.int64),
)  # fmt: skip
ENDLESS = Limits(*(0.0 for _ in Limits._fields))  # of nobody


def crowd_of(solid, surface, count) -> Crowd:
    """Return arrays for so many parts.

    Parameters
    ----------
    solid : TrueSolid
    surface : Surface
    count : int [1]

    Returns
    -------
    Crowd
    """
    corners, edges, plates = len(solid.corners), len(solid.edges), len(surface.plates)
    rims, pairs = len(solid.rims), 2 * PAIRS if count > 1 else 0

    def numbers(*shape) -> np.ndarray:
        return np.zeros((count, *shape))

    def places(*shape) -> np.ndarray:
        return np.zeros((count, *shape), np.int64)

    return Crowd(
        states=numbers(body.STATE), before=numbers(body.STATE), push=numbers(body.STATE), turns=numbers(9),
        tangents=numbers(2), leans=numbers(7), given=numbers(6), free=numbers(3), blown=numbers(7),
        rows=numbers(CONTACTS, contact.WIDTH), counts=places(),
        known=numbers(CONTACTS, 4), knowns=places(), lasted=np.full(count, -1.0),
        made=np.full((count, 10), -1.0), made_at=numbers(3),
        ends=places(plates, LISTS), verts=places(3, 2 * corners), offs=numbers(2 * corners),
        groups=numbers(2 * corners // BLOCK + 1, 6),
        sides=places(SIDES * corners + 100),
        edges=places(NEAR, 3), edge_gaps=numbers(NEAR), posts=places(NEAR, 2), corners=places(NEAR, 3),
        walled=places(corners + 1), wall_gaps=numbers(corners + 1),
        frame=np.zeros(12), shown=np.zeros((corners, 3)), seen=np.zeros(corners, np.int64),
        blocks=np.zeros(edges, np.int64),
        low=np.zeros(max(corners, CONTACTS), np.int64),
        rims=places(plates * rims, 2), rims_walled=places(rims + 1), rounds=places(len(surface.borders)),
        levels=np.zeros((corners + 8 * rims + 2 * CONTACTS, supports.COLUMNS)),
        best=np.zeros((supports.WAYS + 1, 2)), near=np.zeros(max(len(surface.borders), 1), np.int64),
        close=np.zeros(max(len(surface.borders), 1), np.int64),
        box=np.zeros(6),
        dips=np.zeros(len(surface.borders)),
        pairs=np.zeros((pairs, contact.WIDTH)), owners=np.zeros(pairs, np.int64),
        paired=np.zeros(1, np.int64),
        strains=numbers(2), order=places(), islands=np.zeros(count + 1, np.int64),
        least=np.array(solid.vertices.min(axis=0)), most=np.array(solid.vertices.max(axis=0)),
        ours=np.zeros(edges, np.int64), theirs=np.zeros(edges, np.int64),
        faces=np.zeros(len(solid.triangles), np.int64),
    )  # fmt: skip


def move_on(known, surface, crowd, together) -> None:
    """Move a crowd on, all of it at once; fills ``crowd.strains`` and the notes of ``together``.

    Parameters
    ----------
    known : Known
    surface : Surface
    crowd : Crowd
    together : Together
    """
    crowd.strains[:] = 0.0
    travel.ride(surface, ENDLESS, known.solid, known.floor, crowd, NOBODY, together)
