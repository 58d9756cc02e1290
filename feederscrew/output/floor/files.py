"""What ``feeder floor`` leaves in its folder."""

import numpy as np

from feederscrew.output import offers as offer
from feederscrew.output.floor import tables

FINE = 181  # values of each quantity of a map in a picture
LABELS = {
    "beta_friction": ("vibration angle β [deg]", "friction μ [1]"),
    "frequency_amplitude": ("frequency f [Hz]", "amplitude A [mm]"),
}
ACCELERATION = "acceleration V'_z [m/s²]"
ALTS = {
    "beta_friction": "Acceleration along the heading over vibration angle and friction",
    "frequency_amplitude": "Acceleration along the heading over frequency and amplitude",
}


def offers(study, settings):
    """Offer the files of a FloorStudy.

    Parameters
    ----------
    study : FloorStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    list of Offer
    """
    plan = offer.picture("floor_plan.png", "The part from above, with the forces on it", _plan, study)
    return [
        offer.document("floor.json", tables.document, study, settings),
        offer.table("floor_cycle.csv", tables.over_cycle, study.cycle, study.course),
        *(offer.table(f"floor_{kind}.csv", tables.map_cells, study, kind) for kind in tables.MAPS),
        offer.table("floor_heading.csv", tables.alignment, study),
        *(offer.picture(f"floor_{kind}.png", ALTS[kind], _map, study, kind) for kind in tables.MAPS),
        offer.picture("floor_heading.png", "Alignment acceleration over the heading", _alignment, study),
        offer.picture("floor_cycle.png", "Forces and velocity over one cycle", _cycle, study),
        *([plan] if len(study.posture.outline) else []),
    ]


def _map(study, kind):
    from feederscrew.output.floor.map_figures import regime_map

    drive = study.bowl.drive
    own = {
        "beta_friction": (np.degrees(drive.vibration_angle), study.bowl.friction.kinetic),
        "frequency_amplitude": (drive.frequency, 1e3 * drive.amplitude),
    }
    grid = tables.MAPS[kind](study, FINE)
    return regime_map(
        grid, "acceleration_z_m_s2", title=_title(study), labels=LABELS[kind], value=ACCELERATION,
        own=own[kind], note=tables.map_notes(kind, grid),
    )  # fmt: skip


def _alignment(study):
    from feederscrew.output.floor import figures

    stable = float(np.degrees(study.stable_heading))
    return figures.alignment(tables.alignment(study), stable, _name(study))


def _cycle(study):
    from feederscrew.output.floor import figures

    return figures.cycle(study.cycle, study.course, _title(study))


def _plan(study):
    from feederscrew.output.floor import figures

    return figures.plan(study.posture, study.heading, study.now)


def _title(study):
    return f"{_name(study)}, heading {np.degrees(study.heading):.4g}°"


def _name(study):
    return f"{study.part.name}, aspect {study.posture.name}"
