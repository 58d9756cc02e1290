"""Dynamic bowl tests as tables and documents."""

import numpy as np

from feederscrew.dropping.plate.occupancy import FEW
from feederscrew.output import tables
from feederscrew.units import MM, MM_S, counted

SURFACE = ("restitution", "friction")  # of a launch: the plate's own
HIDDEN = ("velocity_low_mm_s", "velocity_high_mm_s")  # in a table for people
TIMES = 101  # rows an aspect in the course over time, at most


def plates(study):
    """Return how often parts lie on each aspect of each plate, and how fast they travel there.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    Frame
        The columns of ``plate.csv``, one row a plate and aspect.
    """
    return _labelled(study, _plate)


def spare(frame):
    """Return groups of columns to leave out of a table for people that is too wide; empty ones go first."""
    limit = ("p_limit", "p_limit_low", "p_limit_high")
    groups = [limit, ("height_mm",), ("throw_number",), ("p_start",)]
    return groups if np.isnan(frame["p_limit"]).all() else groups[1:] + groups[:1]


def rates(study):
    """Return the transitions seen and their rate, one row a plate and pair of aspects: ``plate_rates.csv``.

    A row whose two aspects are the same counts tips onto an equal face.
    """
    return _labelled(study, _rates)


def course(study):
    """Return the share of the parts on each aspect over time: ``plate_time.csv``."""
    return _labelled(study, _course)


def drives(study):
    """Return how fast parts travel on each plate, and how much was seen: ``plate_drives.csv``."""
    return _labelled(study, _drive)


def summary(study):
    """Yield how fast parts travel on each plate, a line each."""
    for plate, name in zip(study.plates, study.names):
        yield f"{_where(plate, name)}: {travels(plate, 4)}, {plate.transitions} transitions seen"


def travels(result, digits):
    """Return the mean velocity on one plate and, of several parts, its interval."""
    speed, low, high = (f"{end:.{digits}g}" for end in result.occupancy.velocity / MM_S)
    return f"travels at {speed} mm/s" + f" ({low} to {high})" * (result.parts > 1)


def document(study):
    """Return the test as one JSON document.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    dict
    """
    return {
        "part": study.part.name,
        "seed": study.seed,
        "launch": {name: value for name, value in study.plates[0].launch.items() if name not in SURFACE},
        "partial": study.partial,
        "plates": [_one(study.aspects, *pair) for pair in zip(study.plates, study.names)],
    }


def remarks(study):
    """Return what a user must know of a test, a line each."""
    listed = []
    for plate, name in zip(study.plates, study.names):
        where = _where(plate, name)
        if changing := _changing(study.aspects, plate):
            listed.append(
                f"{where}: the share of {', '.join(changing)} still changes; give a longer `seconds`"
            )
        if plate.unsettled:
            listed.append(f"{where}: {plate.unsettled} of {plate.parts} parts lay on no aspect to the end")
        if plate.lost:
            listed.append(f"{where}: {counted(plate.lost, 'part')} could not be followed, not counted")
        if 0 < plate.transitions < FEW:
            few = f"too few transitions ({plate.transitions}) for p_limit"
            listed.append(f"{where}: {few}; give more `drops` or `seconds`")
    if study.partial:
        listed.append(f"partial: stopped after {counted(plate.parts, 'part')} on the plate of {where}")
    return listed


def notes(bowls):
    """Return what is simplified in a bowl's plate, a line each."""
    if any(bowl.friction.kinetic < bowl.friction.static for bowl in bowls):
        yield "the plate has one coefficient of friction: the kinetic one, for sticking too"
    if any(bowl.friction.backward != (bowl.friction.static, bowl.friction.kinetic) for bowl in bowls):
        yield "the plate has the same friction in every direction: that of slip up the track"


def _where(result, name):
    return f"{name} at {result.bowl.drive.amplitude / MM:.4g} mm"


def _changing(aspects, plate):
    """Aspects whose share still changes."""
    return [name for name, changing in zip(aspects.names, plate.occupancy.changing) if changing]


def _labelled(study, columns):
    """The columns of all plates as a table; once the user stopped, which plate is not whole."""
    parts = [columns(study.aspects, *pair) for pair in zip(study.plates, study.names)]
    joined = {name: np.concatenate([np.asarray(part[name]) for part in parts]) for name in parts[0]}
    if study.partial:
        lengths = [len(part["bowl"]) for part in parts]
        joined["partial"] = np.repeat([plate.partial for plate in study.plates], lengths)
    return tables.frame(joined)


def _head(result, name, count):
    """The columns that say which plate a row is of."""
    drive = result.bowl.drive
    values = {"bowl": name, "amplitude_mm": drive.amplitude / MM, "throw_number": result.throw_number}
    return {key: [value] * count for key, value in values.items()}


def _drive(aspects, result, name):
    ends = ("velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s")
    return {
        **_head(result, name, 1),
        "drops": [result.parts],
        "seconds": [result.seconds],
        "unsettled": [result.unsettled],
        "transitions": [result.transitions],
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
        "unsettled": result.unsettled,
        "seconds": result.seconds,
        "steady": not seen.changing.any(),
        "changing": _changing(aspects, result),
        "transitions_seen": result.transitions,
        **velocity,
        "aspects": tables.frame({k: v for k, v in _plate(aspects, result, name).items() if k not in head}),
        "rates": tables.frame({k: v for k, v in _rates(aspects, result, name).items() if k not in head}),
    }
