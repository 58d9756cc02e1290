"""A bowl, and how a part slips, lies and travels in it."""

from collections.abc import Iterable, Sequence

from feederscrew import bowl as bowls
from feederscrew.api import asked
from feederscrew.api.asked import Path, Quantity
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.studies.convey import ConveyStudy
from feederscrew.studies.floor import FloorStudy
from feederscrew.studies.headings import HeadingsStudy
from feederscrew.studies.slide import SlideStudy
from feederscrew.studies.track import TrackStudy


def read_bowl(path: Path | None = None, overrides: str | Sequence[str] = ()) -> Bowl:
    """Read a bowl from its file, from 'drive.frequency=50 Hz', or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : str or sequence of str
        Such as 'drive.frequency=50 Hz'; the last of one key holds.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    return bowls.read(None if path is None else asked.a_file("path", path), asked.overrides(overrides))


def slide(bowl: Bowl, angles: Iterable[Quantity] = (), *, as_published: bool = False) -> SlideStudy:
    """Compute when a part slips, which way, and when it hops, as ``feeder slide``.

    Parameters
    ----------
    bowl : Bowl
    angles : iterable of str or float [rad]
        Vibration angles, a map each; the bowl's without them.
    as_published : bool
        Keep mu_limit where [4.27] is negative, as past the hop.

    Returns
    -------
    SlideStudy
    """
    from feederscrew.studies.slide import slide as study

    betas = tuple(asked.amount("angles", one, "angle") for one in angles)
    return study(asked.a_bowl(bowl), betas, as_published=as_published)


def convey(bowl: Bowl) -> ConveyStudy:
    """Compute how a part travels on the bowl's track, as ``feeder convey``.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    ConveyStudy
        Its ``answer`` has the velocity in m/s, status, regime and margins.
    """
    from feederscrew.studies.convey import convey as study

    return study(asked.a_bowl(bowl))


def floor(part: Part, bowl: Bowl, aspect: str | None = None, *, heading: Quantity = 0.0) -> FloorStudy:
    """Compute the forces on a part on the bowl's floor and what it does, as ``feeder floor``.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name; the likeliest without it.
    heading : str or float [rad]
        '90 deg': how it lies to the drive.

    Returns
    -------
    FloorStudy
    """
    from feederscrew.studies.floor import floor as study

    lies = asked.amount("heading", heading, "angle")
    return study(asked.a_part(part), asked.a_bowl(bowl), aspect, lies)


def track(
    part: Part, bowl: Bowl, aspect: str | None = None, *, heading: Quantity | None = None
) -> TrackStudy:
    """Compute the reactions on a part on the track against the wall, as ``feeder track``.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name; the likeliest without it.
    heading : str or float [rad], optional
        As laid down; the most frequent that stays on the track without it.

    Returns
    -------
    TrackStudy
    """
    from feederscrew.studies.track import track as study

    return study(asked.a_part(part), asked.a_bowl(bowl), aspect, asked.angle("heading", heading))


def headings(part: Part, bowl: Bowl, aspect: str | None = None) -> HeadingsStudy:
    """Find how a part lies along the track's wall, as ``feeder headings``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        One alone; every stable one without it.

    Returns
    -------
    HeadingsStudy
    """
    from feederscrew.studies.headings import headings as study
    from feederscrew.studies.rate import arriving

    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl)
    return study(solid, bowl.track, aspect, arriving(solid, bowl))
