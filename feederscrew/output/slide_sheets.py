"""What ``feeder slide`` leaves in its folder."""

import numpy as np

from feederscrew import maps
from feederscrew.output import plots, slide_plots, slide_tables, tables


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
        folder.write(f"slide_surface_{angle}.png", plots.png(slide_plots.surface(one)))
        folder.write(f"slide_contours_{angle}.png", plots.png(slide_plots.contours(one)))
        folder.write(f"slide_regimes_{angle}.png", plots.png(slide_plots.regimes(one)))
    folder.write("slide_curves.png", plots.png(slide_plots.curves(fine)))
