"""What ``feeder floor`` leaves in its folder."""

import numpy as np

from feederscrew import check
from feederscrew.mechanics.floor import cells as floor_cells
from feederscrew.mechanics.floor.balance import STATES
from feederscrew.output import style, tables
from feederscrew.output.floor import figures as floor_plots
from feederscrew.output.floor.map_figures import regime_map
from feederscrew.studies import maps

COARSE, FINE = 46, 181  # values of each quantity of a map, in a table and in a picture
TOP_ANGLE, TOP_FRICTION = 90.0, 1.0  # [deg], [1] as Figure 5-6
LEAST_FREQUENCY, TOP_FREQUENCY, TOP_AMPLITUDE = 10.0, 120.0, 0.5e-3  # [Hz], [Hz], [m] as Figure 5-7, or more
LABELS = {
    "beta_friction": ("vibration angle β [deg]", "friction μ [1]"),
    "frequency_amplitude": ("frequency f [Hz]", "amplitude A [mm]"),
}
ACCELERATION = "acceleration V'_z [m/s²]"


def floor(folder, found, document, *, pictures=True):
    """Write the cycle, the maps and the pictures.

    Parameters
    ----------
    folder : ResultFolder
    found : FloorAnalysis
    document : dict
        Of the JSON file.
    pictures : bool
        Draw as well.

    Returns
    -------
    list of str
        What a reader of the maps should know.
    """
    folder.write("floor.json", tables.json_text(document))
    folder.write("floor_cycle.csv", tables.text(tables.frame(document["cycle"]), "csv"))
    grids = _maps(found, COARSE)
    for name, grid in grids.items():
        folder.write(f"floor_{name}.csv", tables.text(tables.frame(grid.columns()), "csv"))
    turn = _alignment(found.posture, found.bowl)
    folder.write("floor_heading.csv", tables.text(tables.frame(turn), "csv"))
    if pictures:
        _draw(folder, found, turn, document["instant"]["stable_heading_deg"])
    return [line for name, grid in grids.items() for line in _told(name, grid)]


def _maps(found, count):
    """The two maps of chapter 5 for this part and bowl."""
    posture, bowl, heading = found.posture, found.bowl, found.heading
    highest = max(TOP_FREQUENCY, 1.25 * bowl.drive.frequency)
    widest = max(TOP_AMPLITUDE, 1.25 * bowl.drive.amplitude)
    angle = maps.Axis("beta_deg", _span(0.0, np.radians(TOP_ANGLE), count), np.pi / 180.0)
    friction = maps.Axis("friction", _span(0.0, TOP_FRICTION, count))
    frequency = maps.Axis("frequency_Hz", _span(LEAST_FREQUENCY, highest, count))
    amplitude = maps.Axis("amplitude_mm", _span(0.0, widest, count), 1e-3)

    def by_angle(beta, mu):
        return floor_cells.over_angle_and_friction(posture, bowl, heading, beta, mu)

    def by_frequency(f, a):
        return floor_cells.over_frequency_and_amplitude(posture, bowl, heading, f, a)

    return {
        "beta_friction": maps.evaluate(angle, friction, by_angle, floor_cells.REGIMES),
        "frequency_amplitude": maps.evaluate(frequency, amplitude, by_frequency, floor_cells.REGIMES),
    }


def _alignment(posture, bowl):
    """theta'' over every heading."""
    degrees = np.arange(-180.0, 181.0, 1.0)
    cells = floor_cells.cells(posture, bowl, np.radians(degrees))
    names = ("alignment_acceleration_rad_s2", "published_alignment_rad_s2")
    return {"heading_deg": degrees, **{name: cells[name] for name in names}}


def _draw(folder, found, turn, stable):
    posture, drive = found.posture, found.bowl.drive
    name = f"{found.part.name}, aspect {posture.name}"
    title = f"{name}, heading {np.degrees(found.heading):.4g}°"
    own = {
        "beta_friction": (np.degrees(drive.vibration_angle), found.bowl.friction.kinetic),
        "frequency_amplitude": (drive.frequency, 1e3 * drive.amplitude),
    }
    for kind, grid in _maps(found, FINE).items():
        drawn = regime_map(
            grid, "acceleration_z_m_s2", title=title, labels=LABELS[kind], value=ACCELERATION, own=own[kind],
            note=" ".join(_told(kind, grid)),
        )  # fmt: skip
        folder.write(f"floor_{kind}.png", style.png(drawn))
    folder.write("floor_heading.png", style.png(floor_plots.alignment(turn, stable, name)))
    folder.write("floor_cycle.png", style.png(floor_plots.cycle(found.cycle, found.course, title)))
    if len(posture.outline):
        folder.write("floor_plan.png", style.png(floor_plots.plan(posture, found.heading, found.now)))


def _told(name, grid):
    """A sentence where a map has nothing that slides."""
    if STATES.index("slide") in grid.codes:
        return []
    return [f"{name.replace('_', ' and ')}: nothing slides anywhere on this map."]


def _span(low, high, count):
    return check.frozen(np.linspace(low, high, count))
