"""Virtual tests of a part that is dropped: on a hard plane, and on the moving floor of a bowl."""

from collections.abc import Sequence
from typing import Unpack

from feederscrew.api import asked
from feederscrew.api.asked import Condition, Quantity
from feederscrew.api.bowl_settings import DriveSettings, Overrides, with_settings
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.studies.simulated import drop as drop_tests
from feederscrew.studies.simulated import plate as plates
from feederscrew.studies.simulated.drop import DropStudy
from feederscrew.studies.simulated.plate import PlateStudy


def drop(
    part: Part,
    *,
    launch: str = "feed",
    drops: int | None = None,
    seed: int = 1,
    jobs: int = 1,
    traced: int = 0,
    fall: Condition = None,
    spin: Condition = None,
    speed: Condition = None,
    restitution: Condition = None,
    friction: Condition = None,
) -> DropStudy:
    """Run a virtual drop test on a hard plane, as ``feeder drop``.

    Parameters
    ----------
    part : Part
        From a mesh.
    launch : str
        'place', 'drop', 'flip', 'roll' or 'feed': what was done to the part.
    drops : int, optional
        How many; 10,000 without it.
    seed : int
        Of the random launches.
    jobs : int
        Cores to use; the counts do not depend on it.
    traced : int
        Of how many drops, from the first, the motion is kept as well.
    fall, spin, speed, restitution, friction : str, float or pair of them [m, rad/s, m/s, 1, 1], optional
        Ranges that replace the launch's: fall='20 mm:50 mm' or fall=(0.02, 0.05).

    Returns
    -------
    DropStudy
        Its ``tally`` has counts, shares and intervals by class, in the order of ``find_aspects``.

    Raises
    ------
    FeederError
        If the part has no shape, or an argument is of the wrong kind or out of range.
    """
    ranges = asked.conditions(fall=fall, spin=spin, speed=speed, restitution=restitution, friction=friction)
    many = asked.count("drops", drops)
    solid = asked.a_part(part, mesh=True)
    return drop_tests.drop(solid, launch, ranges, drops=many, seed=seed, jobs=jobs, traced=traced)


@with_settings
def shake(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    *,
    launch: str = "feed",
    drops: int | None = None,
    seconds: Quantity | None = None,
    seed: int = 1,
    jobs: int = 1,
    fall: Condition = None,
    spin: Condition = None,
    speed: Condition = None,
    restitution: Condition = None,
    friction: Condition = None,
    overrides: Overrides = (),
    **settings: Unpack[DriveSettings],
) -> PlateStudy:
    """Run a virtual dynamic bowl test, as ``feeder drop --plate``: parts on a plate with each bowl's drive.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : Bowl or sequence of Bowl
    launch : str
        As for ``drop``.
    drops : int, optional
        Parts on each plate; 400 without it.
    seconds : str or float [s], optional
        How long each is followed; 5 without it.
    seed, jobs, fall, spin, speed, restitution, friction
        As for ``drop``; restitution and friction are each bowl's unless given.
    overrides, **settings
        As for ``read_bowl``, amplitude='0.3 mm': in place of each bowl's own.

    Returns
    -------
    PlateStudy
        Its ``plates``, one a bowl, have ``occupancy``: shares, transition rates and velocities with their
        intervals.

    Raises
    ------
    FeederError
        As for ``drop``.
    """
    ranges = asked.conditions(fall=fall, spin=spin, speed=speed, restitution=restitution, friction=friction)
    return plates.plate(
        asked.a_part(part, mesh=True),
        asked.some_bowls(bowls, overrides, settings),
        launch,
        ranges,
        drops=asked.count("drops", drops),
        seconds=None if seconds is None else asked.amount("seconds", seconds, "time", plates.LEAST),
        seed=seed,
        jobs=jobs,
    )
