"""A bowl, and how a part slips, lies and travels in it."""

from collections.abc import Iterable
from typing import Unpack

from feederscrew import bowl as bowls
from feederscrew.api import asked
from feederscrew.api.asked import Path, Quantity
from feederscrew.api.bowl_settings import BowlSettings, Overrides, override_texts, with_settings
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.studies import convey as conveying
from feederscrew.studies import floor as floors
from feederscrew.studies import headings as lying
from feederscrew.studies import slide as sliding
from feederscrew.studies import track as tracks
from feederscrew.studies.convey import ConveyStudy
from feederscrew.studies.floor import FloorStudy
from feederscrew.studies.headings import HeadingsStudy
from feederscrew.studies.rate import arriving
from feederscrew.studies.slide import SlideStudy
from feederscrew.studies.track import TrackStudy


@with_settings
def read_bowl(path: Path | None = None, overrides: Overrides = (), **settings: Unpack[BowlSettings]) -> Bowl:
    """Read a bowl from its file, from settings, or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : dict, str or sequence of str
        {'drive.frequency': '50 Hz'} or 'drive.frequency=50 Hz'; the last of one key holds.
    **settings : str or float [SI]
        Keys of a bowl file by their last word, amplitude='0.3 mm'. They go over the overrides, and these
        over the file.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    texts = override_texts(overrides, settings)
    return bowls.read(None if path is None else asked.a_file("path", path), texts)


@with_settings
def slide(
    bowl: Bowl,
    angles: Iterable[Quantity] = (),
    *,
    as_published: bool = False,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> SlideStudy:
    """Compute when a part slips, which way, and when it hops, as ``feeder slide``.

    Parameters
    ----------
    bowl : Bowl
    angles : iterable of str or float [rad]
        Vibration angles, a map each; the bowl's without them.
    as_published : bool
        Keep mu_limit where [4.27] is negative, as past the hop.
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    SlideStudy
    """
    betas = tuple(asked.amount("angles", one, "angle") for one in angles)
    return sliding.slide(asked.a_bowl(bowl, overrides, settings), betas, as_published=as_published)


@with_settings
def convey(bowl: Bowl, *, overrides: Overrides = (), **settings: Unpack[BowlSettings]) -> ConveyStudy:
    """Compute how a part travels on the bowl's track, as ``feeder convey``.

    Parameters
    ----------
    bowl : Bowl
    overrides, **settings
        As for ``read_bowl``, amplitude='0.3 mm': in place of the bowl's own.

    Returns
    -------
    ConveyStudy
        Its ``answer`` has the velocity in m/s, status, regime and margins.
    """
    return conveying.convey(asked.a_bowl(bowl, overrides, settings))


@with_settings
def floor(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity = 0.0,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> FloorStudy:
    """Compute the forces on a part on the bowl's floor and what it does, as ``feeder floor``.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name; the likeliest without it.
    heading : str or float [rad]
        '90 deg': how it lies to the drive.
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    FloorStudy
    """
    angle = asked.amount("heading", heading, "angle")
    return floors.floor(asked.a_part(part), asked.a_bowl(bowl, overrides, settings), aspect, angle)


@with_settings
def track(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
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
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    TrackStudy
    """
    angle = asked.angle("heading", heading)
    return tracks.track(asked.a_part(part), asked.a_bowl(bowl, overrides, settings), aspect, angle)


@with_settings
def headings(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> HeadingsStudy:
    """Find how a part lies along the track's wall, as ``feeder headings``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        One alone; every stable one without it.
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    HeadingsStudy
    """
    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl, overrides, settings)
    return lying.headings(solid, bowl.track, aspect, arriving(solid, bowl))
