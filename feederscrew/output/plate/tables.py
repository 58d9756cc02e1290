"""Dynamic bowl tests as tables and documents."""

import numpy as np

from feederscrew import units
from feederscrew.dropping.plate.occupancy import FEW
from feederscrew.output import tables
from feederscrew.output.columns import MM

MM_S = units.factor("mm/s", "velocity")
SURFACE = ("restitution", "friction")  # of a launch: the plate's own
HIDDEN = ("velocity_low_mm_s", "velocity_high_mm_s")  # in a table for people
TIMES = 101  # rows an aspect in the course over time, at most


def plates(aspects, results, names):
    """One row a plate and aspect: how often parts lie on it, and how fast they travel there.

    Parameters
    ----------
    aspects : Aspects
    results : sequence of feederscrew.dropping.plate.runs.Shaken
    names : sequence of str
        Of the bowl of each result.

    Returns
    -------
    DataFrame
        The columns of ``plate.csv``.
    """
    return _labelled([_plate(aspects, *pair) for pair in zip(results, names)], results)


def rates(aspects, results, names):
    """One row a plate and pair of aspects: the transitions seen and their rate; ``plate_rates.csv``.

    A row whose two aspects are the same counts tips onto an equal face.
    """
    return _labelled([_rates(aspects, *pair) for pair in zip(results, names)], results)


def course(aspects, results, names):
    """One row a plate, time and aspect: the share of the parts there; ``plate_time.csv``."""
    return _labelled([_course(aspects, *pair) for pair in zip(results, names)], results)


def drives(results, names):
    """One row a plate: how fast parts travel on it, and how much was seen; ``plate_drives.csv``."""
    return _labelled([_drive(*pair) for pair in zip(results, names)], results)


def told(results, names):
    """How fast parts travel on each plate, a line each."""
    for result, name in zip(results, names):
        yield f"{_where(result, name)}: {travels(result, 4)}, {_seen(result.occupancy)} transitions seen"


def travels(result, digits):
    """The mean velocity on one plate and, of several parts, its interval."""
    speed, low, high = (f"{end:.{digits}g}" for end in result.occupancy.velocity / MM_S)
    return f"travels at {speed} mm/s" + f" ({low} to {high})" * (result.parts > 1)


def document(part, aspects, seed, results, names):
    """The test as one JSON document.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    seed : int
    results, names
        As for `plates`.

    Returns
    -------
    dict
    """
    return {
        "part": part.name,
        "seed": seed,
        "launch": {name: value for name, value in results[0].launch.items() if name not in SURFACE},
        "partial": any(result.partial for result in results),
        "plates": [_one(aspects, *pair) for pair in zip(results, names)],
    }


def remarks(document):
    """What a user must know of a test, a line each."""
    told = []
    for plate in document["plates"]:
        where, seen = f"{plate['bowl']} at {plate['amplitude_mm']:.4g} mm", plate["transitions_seen"]
        if plate["changing"]:
            listed = ", ".join(plate["changing"])
            told.append(f"{where}: the share of {listed} still changes; give a longer --seconds")
        if plate["unsettled"]:
            told.append(
                f"{where}: {plate['unsettled']} of {plate['drops']} parts lay on no aspect to the end"
            )
        if plate["lost"]:
            told.append(f"{where}: {plate['lost']} parts could not be followed and are left out")
        if 0 < seen < FEW:
            told.append(f"{where}: too few transitions ({seen}) for p_limit; give more --drops or --seconds")
    if document["partial"]:
        told.append(f"partial: stopped after {plate['drops']} parts on the plate of {where}")
    return told


def notes(bowls):
    """What is simplified in a bowl's plate, a line each."""
    if any(bowl.friction.kinetic < bowl.friction.static for bowl in bowls):
        yield "the plate has one coefficient of friction: the kinetic one, for sticking too"
    if any(bowl.friction.backward != (bowl.friction.static, bowl.friction.kinetic) for bowl in bowls):
        yield "the plate has the same friction in every direction: that of slip up the track"


def _where(result, name):
    return f"{name} at {result.bowl.drive.amplitude / MM:.4g} mm"


def _seen(seen):
    """Transitions between classes."""
    return int(seen.counts.sum() - np.trace(seen.counts))


def _unsettled(result):
    """Parts that have not lain on any face yet."""
    return round(result.parts * (1.0 - float(result.occupancy.course[-1].sum())))


def _labelled(parts, results):
    """The columns of all plates as a table; once the user stopped, which plate is not whole."""
    columns = {name: np.concatenate([np.asarray(part[name]) for part in parts]) for name in parts[0]}
    if any(result.partial for result in results):
        lengths = [len(part["bowl"]) for part in parts]
        columns["partial"] = np.repeat([result.partial for result in results], lengths)
    return tables.frame(columns)


def _head(result, name, count):
    """The columns that say which plate a row is of."""
    drive = result.bowl.drive
    told = {"bowl": name, "amplitude_mm": drive.amplitude / MM, "throw_number": result.throw_number}
    return {key: [value] * count for key, value in told.items()}


def _drive(result, name):
    ends = ("velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s")
    return {
        **_head(result, name, 1),
        "drops": [result.parts],
        "seconds": [result.seconds],
        "unsettled": [_unsettled(result)],
        "transitions": [_seen(result.occupancy)],
        "steady": ["no" if result.occupancy.changing.any() else "yes"],
        **{end: [result.occupancy.velocity[k] / MM_S] for k, end in enumerate(ends)},
    }


def _plate(aspects, result, name):
    seen = result.occupancy
    return {
        **_head(result, name, len(aspects.names)),
        "aspect": aspects.names,
        "height_mm": aspects.heights / MM,
        "p_start": seen.start,
        "p_plate": seen.plate,
        "p_plate_low": seen.plate_low,
        "p_plate_high": seen.plate_high,
        "p_limit": seen.limit,
        "p_limit_low": seen.limit_low,
        "p_limit_high": seen.limit_high,
        **{
            f"velocity{end}_mm_s": seen.velocities[:, k] / MM_S for k, end in enumerate(("", "_low", "_high"))
        },
    }


def _rates(aspects, result, name):
    seen, names = result.occupancy, np.array(aspects.names)
    before, after = np.nonzero(np.ones(seen.counts.shape, bool) & (seen.times > 0.0)[:, None])
    return {
        **_head(result, name, len(before)),
        "from": names[before],
        "to": names[after],
        "count": seen.counts[before, after],
        "rate_per_s": seen.rates[before, after],
        "rate_low_per_s": seen.rates_low[before, after],
        "rate_high_per_s": seen.rates_high[before, after],
    }


def _course(aspects, result, name):
    shares = result.occupancy.course
    looks = np.unique(np.linspace(0, len(shares) - 1, TIMES).astype(int))
    time = looks * result.seconds / (len(shares) - 1)
    return {
        **_head(result, name, len(looks) * len(aspects.names)),
        "time_s": np.repeat(time, len(aspects.names)),
        "aspect": np.tile(aspects.names, len(looks)),
        "p": shares[looks].ravel(),
    }


def _one(aspects, result, name):
    """One plate of the document."""
    drive, seen = result.bowl.drive, result.occupancy
    velocity = dict(zip(("velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s"), seen.velocity / MM_S))
    head = ("bowl", "amplitude_mm", "throw_number")
    return {
        "bowl": name,
        "amplitude_mm": drive.amplitude / MM,
        "frequency_Hz": drive.frequency,
        "vibration_angle_deg": float(np.degrees(drive.vibration_angle)),
        "throw_number": result.throw_number,
        **{name: result.launch[name] for name in SURFACE},
        "drops": result.parts,
        "lost": result.lost,
        "unsettled": _unsettled(result),
        "seconds": result.seconds,
        "steady": not seen.changing.any(),
        "changing": [name for name, changing in zip(aspects.names, seen.changing) if changing],
        "transitions_seen": _seen(seen),
        **velocity,
        "aspects": tables.frame({k: v for k, v in _plate(aspects, result, name).items() if k not in head}),
        "rates": tables.frame({k: v for k, v in _rates(aspects, result, name).items() if k not in head}),
    }
