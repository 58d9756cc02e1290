"""What ``feeder track`` leaves in its folder."""

import numpy as np

from feederscrew.output import style, tables
from feederscrew.output.floor.map_figures import regime_map
from feederscrew.output.track import figures as track_plots
from feederscrew.output.track import maps as track_maps


def track(folder, found, document, grid, *, pictures=True):
    """Write the cycle, the map and the pictures.

    Parameters
    ----------
    folder : ResultFolder
    found : TrackAnalysis
    document : dict
        Of the JSON file.
    grid : Grid
    pictures : bool
        Draw as well.
    """
    folder.write("track.json", tables.json_text(document))
    folder.write("track_cycle.csv", tables.text(tables.frame(document["cycle"]), "csv"))
    folder.write("track_map.csv", tables.text(track_maps.cells(grid), "csv"))
    for name in ("difference", "omitted_terms"):
        if name in document:
            folder.write(f"track_{name}.csv", tables.text(document[name], "csv"))
    if not pictures:
        return
    title = f"{found.part.name}, aspect {found.posture.name}, heading {np.degrees(found.seat.heading):.4g}°"
    folder.write("track_part.png", style.png(track_plots.part(found, title)))
    folder.write("track_cycle.png", style.png(track_plots.cycle(found.cycle, found.course, title)))
    labels = tuple(" ".join(tables.heading(axis.column)) for axis in (grid.first, grid.second))
    drawn = regime_map(
        grid, track_maps.SHOWN, title=title, labels=labels,
        value="acceleration V'_X at the upper reversal [m/s²]",
        own=track_maps.own_point(grid, found.bowl), note=" ".join(track_maps.remarks(grid)),
    )  # fmt: skip
    folder.write("track_map.png", style.png(drawn))
