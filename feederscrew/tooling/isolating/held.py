"""What holds a part on its round side on the track: a bank towards the wall, or a groove."""

import math
from dataclasses import replace

from feederscrew.tooling.devices.kinds import made
from feederscrew.tooling.isolating.chain import WHERE
from feederscrew.tooling.isolating.proposal import plain_cut

LEAST, MOST, MORE = 6.0, 15.0, 1.0  # [deg] of a bank, and beyond the angle that just holds
ANGLE = 30.0  # [deg] of a groove's faces
# [deg] of what is tried beside that: the steepest groove first, in which what turns has farther to fall
BANKS, GROOVES = (6.0, 10.0, 15.0), (55.0, 45.0, 30.0, 15.0)


def stretches(one, wall_friction, before, wishes):
    """Return the stretches of track that hold an orientation which rolls on the level, devices in order.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    wall_friction : float [1]
    before : sequence of Device
        Of the bowl file: where one leans the track already, nothing is added.
    wishes : Wishes

    Returns
    -------
    tuple of Device
        A bank; where it would have to be steep, a groove and a low bank behind it; none where it holds.
    """
    leans = one.track.bank > 0.0 or any(device.leans for device in before)
    if one.kind != "rolling" or leans or not wishes.allows("bank"):
        return ()
    steep = math.inf
    if wall_friction > 0.0:
        steep = math.degrees(math.atan2(math.tan(max(one.track.climb, 0.0)), wall_friction))
    bank = max(LEAST, math.ceil(steep + MORE)) if steep < MOST else math.inf
    if bank <= MOST:
        return (_bank(bank),)
    if not (wishes.allows("groove") and one.rolls_along):
        return ()
    return _groove(ANGLE), _bank(LEAST)


def others(one, found, wishes):
    """Return other stretches of track that may give an orientation more than a design does, one by one.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    found : Design
        Where it isolates, only what may turn more parts into the orientation is worth another track.
    wishes : Wishes

    Returns
    -------
    list of tuple of Device
    """
    if one.track.bank > 0.0 or not wishes.allows("bank"):
        return []
    known = {cut.device.text for cut in found.cuts if cut.device.kind == "bank"}
    made_of = [] if found.isolated else [(_bank(angle),) for angle in BANKS]
    made_of = [leaning for leaning in made_of if leaning[0].text not in known]
    if wishes.allows("groove") and one.kind == "rolling" and one.rolls_along:
        made_of += [(_groove(angle), _bank(LEAST)) for angle in GROOVES]
    return made_of


def led_on(every, leaning):
    """Return orientations as they are behind some stretches of track."""
    for device in leaning:
        every = tuple(device.onward(one) for one in every)
    return tuple(every)


def with_stretches(found, leaning):
    """Return a design with those stretches before its own devices."""
    return replace(found, cuts=(*(plain_cut(device) for device in leaning), *found.cuts))


def _groove(angle):
    return made("groove", WHERE, angle=math.radians(angle), text=f"{{angle: {angle:g} deg}}")


def _bank(angle):
    return made("bank", WHERE, angle=math.radians(angle), text=f"{angle:g} deg")
