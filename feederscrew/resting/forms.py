"""What each resting aspect is by its form, and what a user must know of those that roll."""

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.resting.faces import EQUAL

FLAT, CYLINDER, CONE = "flat", "cylinder", "cone"
BALL, OFF_CENTRE, WITH_A_FLAT = "ball", "off-centre ball", "ball with a flat"
ROLLING_POSTURE = "on side (rolls)"
SAME_SIZE = 0.02  # share by which two sizes of a part may differ and count as one, for a posture's words
OPPOSITE = -0.9999  # cosine between the normals of two faces that lie back to back
LEVEL_SLOPE = 1e-3  # [1] slope of an axis that counts as level: a file's noise on a short cylinder
BALL_REMARK = "the part is a ball: it rests on no aspect, its one class rolls in every direction"
CENTRED_BALL_REMARK = (
    "a rolling class is the side of a ball about the centre of mass: it rolls in every direction"
)
ROCKING_REMARK = (
    "a rolling class is the side of {}, whose middle is not the centre of mass: it rests on one point of it"
    " and rocks in every direction"
)


def forms(groups, hull) -> list[str]:
    """Return what each class is by its form.

    Parameters
    ----------
    groups : sequence of list of Face
        The faces of each class.
    hull : Hull

    Returns
    -------
    list of str
        'flat'; 'cylinder', which rolls straight; 'cone', which rolls in a circle, as parts on two unlike
        circles do; 'ball', about the centre of mass; 'off-centre ball' and 'ball with a flat', which rest on
        one point of a ball's side and rock: of a part that has no other class, or that has flats as well.
    """
    flats = any(group[0].kind == FLAT for group in groups)
    return [_form(group[0], hull, flats) for group in groups]


def _form(face, hull, flats) -> str:
    if face.kind == FLAT:
        return FLAT
    if np.isfinite(face.axis).all():
        return CYLINDER if abs(vectors.dot(face.axis, face.normal)) < LEVEL_SLOPE else CONE
    if np.ptp(hull.heights[face.triangles]) < EQUAL * face.height:
        return BALL
    return WITH_A_FLAT if flats else OFF_CENTRE


def postures(normals, contact_areas, kinds, hull) -> list[str]:
    """Return in words how a part lies on each class: its height there beside its least and greatest height.

    Parameters
    ----------
    normals : (A, 3) float [1]
        Outward normal of the side that is down.
    contact_areas : (A,) float [m2]
    kinds : sequence of str
        'flat' or 'rolling'.
    hull : Hull

    Returns
    -------
    list of str
        'flat', 'on end' or 'on side'. A flat class adds that the face that is down is the larger or smaller
        of two back to back, or the largest of the part; a rolling class says that it rolls.
    """
    reach = (hull.vertices[:, None, :] * normals[None, :, :]).sum(axis=-1)  # (V, A)
    sizes = np.ptp(reach, axis=0)
    return [
        _posture(row, sizes, contact_areas, normals, hull.radius) if kinds[row] == FLAT else ROLLING_POSTURE
        for row in range(len(normals))
    ]


def _posture(row, sizes, areas, normals, radius) -> str:
    """The words of one flat class."""
    if np.ptp(sizes) <= SAME_SIZE * sizes.max():
        words = "flat" if sizes[row] < radius else "on a face"
    elif sizes[row] <= sizes.min() * (1.0 + SAME_SIZE):
        words = "flat"
    else:
        words = "on end" if sizes[row] >= sizes.max() * (1.0 - SAME_SIZE) else "on side"
    opposite = np.flatnonzero((normals * normals[row]).sum(axis=-1) < OPPOSITE)
    unlike = opposite[np.abs(areas[opposite] - areas[row]) > SAME_SIZE * areas[row]]
    if len(unlike):
        return f"{words} ({'larger' if areas[row] > areas[unlike[0]] else 'smaller'} face)"
    if areas[row] >= areas.max() * (1.0 - SAME_SIZE) and np.ptp(areas) > SAME_SIZE * areas.max():
        return f"{words} (largest face)"
    return words


def form_remarks(forms_of_classes) -> tuple[str, ...]:
    """Say of forms, (A,) str, what a user must know, a sentence each."""
    if list(forms_of_classes) == [BALL]:
        return (BALL_REMARK,)
    rocks = dict.fromkeys(form for form in forms_of_classes if form in (OFF_CENTRE, WITH_A_FLAT))
    listed = (CENTRED_BALL_REMARK,) if BALL in forms_of_classes else ()
    return listed + tuple(
        ROCKING_REMARK.format(f"{'an' if form[0] == 'o' else 'a'} {form}") for form in rocks
    )
