"""Virtual tests of a part that is dropped: on a hard plane, and on the moving floor of a bowl."""

from collections.abc import Sequence

from feederscrew.api import asked
from feederscrew.api.asked import Condition
from feederscrew.bowl import Bowl
from feederscrew.part import Part
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
    **conditions: Condition,
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
    **conditions : str, float or pair of them
        Ranges that replace the launch's: fall='20 mm:50 mm' or fall=(0.02, 0.05), spin, speed, restitution,
        friction.

    Returns
    -------
    DropStudy
        Its ``tally`` has counts, shares and intervals by class, in the order of ``find_aspects``.

    Raises
    ------
    FeederError
        If the part has no shape, or an argument is of the wrong kind or out of range.
    """
    from feederscrew.studies.simulated.drop import drop as study

    given = asked.conditions(conditions)
    many = asked.count("drops", drops)
    solid = asked.a_part(part, mesh=True)
    return study(solid, launch, given, drops=many, seed=seed, jobs=jobs, traced=traced)


def shake(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    *,
    launch: str = "feed",
    drops: int | None = None,
    seconds: float | None = None,
    seed: int = 1,
    jobs: int = 1,
    **conditions: Condition,
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
    seconds : float, optional [s]
        How long each is followed; 5 without it.
    seed, jobs, **conditions
        As for ``drop``; restitution and friction are each bowl's unless given.

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
    from feederscrew.studies.simulated.plate import plate as study

    own = {"drops": asked.count("drops", drops), "seconds": seconds, "seed": seed, "jobs": jobs}
    given, plates = asked.conditions(conditions), asked.some_bowls(bowls)
    return study(asked.a_part(part, mesh=True), plates, launch, given, **own)  # type: ignore[arg-type]
