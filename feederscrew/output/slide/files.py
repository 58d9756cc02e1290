"""What ``feeder slide`` leaves in its folder."""

import numpy as np

from feederscrew.output import style, tables
from feederscrew.output.slide import figures as slide_plots
from feederscrew.output.slide import tables as slide_tables
from feederscrew.studies import maps


def slides(folder, bowl, found, *, pictures=True):
    """Write the cells of every map and its pictures.

    Parameters
    ----------
    folder : ResultFolder
    bowl : Bowl
    found : sequence of SlideMap
        One a vibration angle.
    pictures : bool
        Draw as well.
    """
    folder.write("slide.csv", tables.text(slide_tables.cells(found), "csv"))
    if not pictures:
        return
    fine = [maps.slide(bowl, one.beta, shape=slide_plots.PICTURE) for one in found]
    for one in fine:
        angle = f"beta{np.degrees(one.beta):.6g}"
        folder.write(f"slide_surface_{angle}.png", style.png(slide_plots.surface(one)))
        folder.write(f"slide_contours_{angle}.png", style.png(slide_plots.contours(one)))
        folder.write(f"slide_regimes_{angle}.png", style.png(slide_plots.regimes(one)))
    folder.write("slide_curves.png", style.png(slide_plots.curves(fine)))
