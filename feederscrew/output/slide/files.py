"""What ``feeder slide`` leaves in its folder."""

from functools import cache, partial

import numpy as np

from feederscrew.output import offers as offer
from feederscrew.output.slide import tables

PICTURE = (721, 601)  # cells of a map that is drawn
ALTS = {
    "surface": "Limiting friction over the heading and the acceleration ratio",
    "contours": "Lines of equal limiting friction",
    "regimes": "Regimes of a part over its heading and the acceleration ratio",
}


def offers(study):
    """Offer the files of a SlideStudy, as a list of Offer."""
    fine = cache(partial(study.fine, PICTURE))  # once for all pictures
    pictures = [
        offer.picture(f"slide_{kind}_beta{np.degrees(one.beta):.6g}.png", alt, _draw, kind, fine, place)
        for place, one in enumerate(study.maps)
        for kind, alt in ALTS.items()
    ]
    return [
        offer.table("slide.csv", tables.cells, study.maps),
        *pictures,
        offer.picture("slide_curves.png", "Limiting friction of an aligned part", _curves, fine),
    ]


def _draw(kind, fine, place):
    from feederscrew.output.slide import figures

    return getattr(figures, kind)(fine()[place])


def _curves(fine):
    from feederscrew.output.slide import figures

    return figures.curves(fine())
