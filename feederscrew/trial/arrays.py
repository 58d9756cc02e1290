"""Arrays for the parts on a stretch of track, which the kernel works in."""

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.geometry.compiled import zero_rows
from feederscrew.trial.kernel import travel, workspace
from feederscrew.trial.kernel.plate_views import BLOCK
from feederscrew.trial.kernel.track_contacts import WAYS
from feederscrew.trial.kernel.workspace import Limits, Sent, Together, Workspace

MAX_TRACK_CONTACTS = 96  # of a part with the track at a time
MAX_PAIR_CONTACTS = 400  # contacts between parts at a time
MAX_NEAR_EDGES = 4000  # edges near borders at a time, and faces near their corners
MEAN_BORDERS_PER_CORNER = 12  # borders near a corner, in the mean
NO_CROWD = Together(active=np.zeros(0, bool), time=0.0, steps=0, journals=zero_rows(1, workspace.JOURNAL))
NO_PARTS_SENT = Sent(
    states=np.zeros((0, body.STATE)), times=np.zeros(0), stride=1, paths=np.zeros((0, 0, 8)),
    journals=zero_rows(0, workspace.JOURNAL), outcomes=np.zeros(0, np.int64),
)  # fmt: skip
ENDLESS = Limits(*(0.0 for _ in Limits._fields))  # of nobody


def workspace_of(solid, surface, count) -> Workspace:
    """Return arrays for so many parts.

    Parameters
    ----------
    solid : TrueSolid
    surface : Surface
    count : int [1]

    Returns
    -------
    Workspace
    """
    corners, edges, plates = len(solid.corners), len(solid.edges), len(surface.plates)
    circles, borders, pairs = (
        len(solid.circles),
        len(surface.borders),
        2 * MAX_PAIR_CONTACTS if count > 1 else 0,
    )

    def numbers(*shape) -> np.ndarray:
        return np.zeros((count, *shape))

    def places(*shape) -> np.ndarray:
        return np.zeros((count, *shape), np.int64)

    def records(kind, *shape) -> np.recarray:
        return zero_rows((count, *shape), kind)

    work = Workspace(
        states=numbers(body.STATE), before=numbers(body.STATE), push=numbers(body.STATE), turns=numbers(9),
        tangents=numbers(2), leans=numbers(7), changes=numbers(6), free_rates=numbers(3),
        blown=numbers(6), blown_until=numbers(),
        contacts=records(workspace.CONTACT, MAX_TRACK_CONTACTS), counts=places(),
        remembered=records(workspace.IMPULSES, MAX_TRACK_CONTACTS), remembered_counts=places(),
        last_steps=numbers(),
        listed=records(workspace.LISTED), ends=records(workspace.LIST_COUNTS, plates + 1),
        filled=zero_rows(1, workspace.LIST_COUNTS),
        near_corners=records(workspace.NEAR_CORNER, 2 * corners),
        groups=numbers(2 * corners // BLOCK + 1, 6), sides=places(MEAN_BORDERS_PER_CORNER * corners + 100),
        near_edges=records(workspace.NEAR_EDGE, MAX_NEAR_EDGES),
        near_posts=records(workspace.NEAR_POST, MAX_NEAR_EDGES),
        near_faces=records(workspace.NEAR_FACE, MAX_NEAR_EDGES),
        near_circles=records(workspace.NEAR_CIRCLE, plates * circles), rounds=places(borders),
        wall_corners=records(workspace.NEAR_WALL, corners), wall_circles=places(circles),
        frame=np.zeros(12), views=np.zeros((corners, 3)), viewed=np.zeros(corners, np.int64),
        blocks=np.zeros(edges, np.int64), indices=np.zeros(max(corners, MAX_TRACK_CONTACTS), np.int64),
        supports=zero_rows(corners + 8 * circles + 2 * MAX_TRACK_CONTACTS, workspace.SUPPORT),
        best=np.zeros((WAYS + 1, 2)), borders_near=np.zeros(max(borders, 1), np.int64),
        borders_close=np.zeros(max(borders, 1), np.int64), dips=np.zeros(borders), box=np.zeros(6),
        pairs=zero_rows(pairs, workspace.CONTACT), owners=np.zeros(pairs, np.int64),
        pair_rows=np.zeros(1, np.int64), strains=numbers(2), order=places(),
        islands=np.zeros(count + 1, np.int64),
        least=np.array(solid.vertices.min(axis=0)), most=np.array(solid.vertices.max(axis=0)),
        first_edges=np.zeros(edges, np.int64), second_blocks=np.zeros(edges, np.int64),
        face_blocks=np.zeros(len(solid.triangles), np.int64),
    )  # fmt: skip
    forget(work, slice(None))
    return work


def forget(work, n) -> None:
    """Let no list of part n hold, and no impulse or jet be known of it."""
    work.listed["reach"][n] = work.last_steps[n] = work.blown_until[n] = -1.0


def move_on(bowl_of_part, surface, work, together) -> None:
    """Move a crowd on, all of it at once; fills ``work.strains`` and the journal of ``together``.

    Parameters
    ----------
    bowl_of_part : BowlOfPart
    surface : Surface
    work : Workspace
    together : Together
    """
    work.strains[:] = 0.0
    travel.ride(surface, ENDLESS, bowl_of_part.solid, bowl_of_part.floor, work, NO_PARTS_SENT, together)
