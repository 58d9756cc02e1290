"""Pictures of tosses that were followed one by one."""

import numpy as np

from feederscrew.dropping.launch_file import FACES
from feederscrew.output import style
from feederscrew.units import MM

LOOKS = (  # what is computed of the upper side: label, marker, colour
    ("upper side as measured", "o", "#0072b2"),
    ("another upper side", "X", style.ACCENT),
    ("upper side not measured", "o", style.INK),
)


def plan(study):
    """Draw where each toss came to rest, from the place measured to the place computed.

    Parameters
    ----------
    study : TossStudy
        Of a file with measured ends.

    Returns
    -------
    Figure
    """
    shown = study.result.places / MM
    measured = study.launches.ends[: len(shown)] / MM
    figure = style.figure(6.4, 5.6)
    median = np.nanmedian(study.off) / MM
    title = f"{study.part.name}: {len(shown)} tosses, median distance {median:.3g} mm"
    axes = style.tidy(figure.add_subplot(), title=title, x="x [mm]", y="y [mm]")
    axes.set_aspect("equal")
    axes.plot(*np.stack([measured, shown]).transpose(2, 0, 1), color=style.FAINT, linewidth=0.8, zorder=1)
    kinds = _kinds(study)
    for kind, (label, marker, colour) in enumerate(LOOKS):
        chosen = kinds == kind
        if chosen.any():
            look = {"marker": marker, "color": colour, "s": 18, "linewidths": 0.0}
            axes.scatter(*shown[chosen].T, label=f"computed, {label}", **look)
    axes.scatter(*measured.T, marker=".", s=6, color=style.INK, label="measured")
    figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return figure


def _kinds(study):
    """(N,) index into LOOKS."""
    faces = study.result.faces
    if study.launches.faces is None:
        return np.full(len(faces), 2)
    measured = [FACES.index(face) for face in study.launches.faces[: len(faces)]]
    return np.where(faces == measured, 0, 1)
