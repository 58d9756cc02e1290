"""How many facets a part may have where its true surface is followed, not its hull."""

from feederscrew.errors import FeederError
from feederscrew.part.record import Part

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
