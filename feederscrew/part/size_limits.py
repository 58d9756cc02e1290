"""Sizes of a part that need a word: too many facets to follow, or dimensions as small as the tolerances."""

from collections.abc import Mapping

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.part.record import Part
from feederscrew.units import MM

MAX_FACETS = 20_000  # beyond, verdicts of devices take gigabytes and hours (100,000: 2.3 GB, no end)


def refuse_many_facets(part: Part) -> None:
    """Refuse a part whose surface has more facets than can be followed past devices.

    Parameters
    ----------
    part : Part

    Raises
    ------
    FeederError
        With more than ``MAX_FACETS`` facets. A part card has none.
    """
    if part.faces is not None and len(part.faces) > MAX_FACETS:
        what = f"has {len(part.faces)} facets, too many to follow on the track"
        raise FeederError(part.source, what, f"export it more coarsely, with {MAX_FACETS} facets at most")


SMALL_PART_M = 1e-3  # [m] largest dimension: below it shops measure in other tolerances
SMALL_SHARE, LARGE_SHARE = 0.05, 0.25  # [1] of the largest dimension: said of such a part, and of any


def small_part_remarks(part: Part, allowances: Mapping[str, float], width: float | None) -> tuple[str, ...]:
    """Say where allowances are of the size of a part, or a track is no wider than one.

    Parameters
    ----------
    part : Part
        Nothing is said of one without a surface.
    allowances : mapping of str to float [m]
        'margin', 'play', 'tolerance': they are added up.
    width : float [m], optional
        Of the track.

    Returns
    -------
    tuple of str
        A sentence each, with the numbers.

    Notes
    -----
    A part is compared with its box along the file's axes. It lies on the track with its middle dimension
    across it where it lies as low and as narrow as it can without standing on edge.
    """
    if part.vertices is None:
        return ()
    least, middle, largest = np.sort(np.ptp(part.vertices, axis=0))
    size = " x ".join(f"{length / MM:.3g}" for length in (largest, middle, least))
    remarks = []
    total = sum(allowances.values())
    if total >= (SMALL_SHARE if largest < SMALL_PART_M else LARGE_SHARE) * largest:
        listed = ", ".join(f"{name} {length / MM:.3g} mm" for name, length in allowances.items())
        together = f", together {total / MM:.3g} mm," if len(allowances) > 1 else ""
        exceeds = total > least
        relation = "more than its least dimension" if exceeds else f"{100 * total / least:.2g} % of its least"
        remarks.append(
            f"the part is {size} mm: {listed}{together} are {100 * total / largest:.2g} % of its largest "
            f"dimension and {relation}: give values for such a part"
        )
    if width is not None and width <= middle:
        remarks.append(f"the track, {width / MM:.3g} mm wide, is no wider than one part of {size} mm")
    return tuple(remarks)
