"""Files of ``feeder headings``."""

import numpy as np

from feederscrew.base.columns import Document
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.bowl import texts
from feederscrew.bowl.record import Track
from feederscrew.motion.headings import Headings
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.floor import CONTACT, polygon
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import headings_text
from feederscrew.output.track import wall_and_edge
from feederscrew.part.record import small_part_remarks
from feederscrew.resting.posture import Posture
from feederscrew.sorting.headings import HeadingsStudy

mpl_ticker = heavy("matplotlib.ticker")
shading = heavy("feederscrew.output.shading")

SPARE_COLUMNS = (("straight_wall_share",), ("half_turn_of_deg", "mirror_of_deg"))  # of a table too wide


def document(study: HeadingsStudy) -> Document:
    """Return stable headings as the JSON document.

    Parameters
    ----------
    study : HeadingsStudy

    Returns
    -------
    dict
    """
    headings, bowl = study.table(), texts(study.bowl.settings)
    return {"part": study.part.name, "answer": study.answer, "headings": headings, "bowl": bowl}


def answer(study: HeadingsStudy) -> str:
    """Say whose probabilities of the aspects are taken.

    Parameters
    ----------
    study : HeadingsStudy

    Returns
    -------
    str
    """
    return f"Aspect share: {study.answer}"


def remarks(study: HeadingsStudy) -> list[str]:
    """Return what a reader of stable headings should know, a sentence each.

    Parameters
    ----------
    study : HeadingsStudy

    Returns
    -------
    list of str
    """
    lines, width = list(small_part_remarks(study.part, {}, study.track.width)), study.track.width / MM
    for stable in study.headings:
        if stable.rounded:
            lines.append(f"aspect {stable.aspect} is round in plan: it takes any heading")
        if stable.falls_off.all():
            lines.append(f"aspect {stable.aspect} falls off the track of {width:.4g} mm in every heading")
    return lines


def offers(study: HeadingsStudy) -> list[offer.Offer]:
    """Offer the files of stable headings, with a picture for each aspect.

    Parameters
    ----------
    study : HeadingsStudy

    Returns
    -------
    list of Offer
    """
    offered = [offer.document("headings.json", document, study), offer.table("headings.csv", study.table)]
    for posture, stable in zip(study.postures, study.headings):
        alt = f"Stable headings of aspect {posture.name} from above"
        title = f"{study.part.name}, aspect {posture.name}: heading, share"
        file = f"headings_{posture.name}.png"
        offered.append(offer.picture(file, alt, headings, posture, stable, study.track, title))
    return offered


PANELS_ACROSS = 4
MAX_PANELS = 16  # headings of one picture, the most frequent
SIDE = 2.5  # [in] of one picture
NARROWEST = 0.4  # half a picture's width, over its height above the foot


def headings(posture: Posture, stable: Headings, track: Track, title: str) -> "style.Figure":
    """Draw the part in each stable heading, the wall below, the track's free edge dashed.

    Parameters
    ----------
    posture : Posture
    stable : Headings
        Of that posture.
    track : Track
    title : str

    Returns
    -------
    matplotlib.figure.Figure
        The first ``MAX_PANELS`` of them.
    """
    count = min(len(stable.headings), MAX_PANELS)
    columns, lines = min(PANELS_ACROSS, count), -(-count // PANELS_ACROSS)
    figure = style.figure(max(columns * SIDE, 2 * SIDE), lines * SIDE + 0.6)
    panels = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True).ravel()
    figure.suptitle(title, x=0.01, ha="left", fontsize=10.5, color=style.INK, fontweight="bold")
    size = np.linalg.norm(posture.outline, axis=1).max()
    for row, axes in enumerate(panels[:count]):
        heading, edge = stable.headings[row], "#b5482a" if stable.falls_off[row] else style.INK
        style.tidy(axes, grid="none")
        caption = f"{np.degrees(heading):.4g}°   {100.0 * stable.shares[row]:.1f} %"
        caption += f"\n{stable.lengths[row] / MM:.4g} long, {stable.widths[row] / MM:.4g} wide [mm]\n"
        stays = "overhangs" if stable.overhangs[row] > 0.0 else "stays on"
        caption += "falls off" if stable.falls_off[row] else stays
        axes.set_title(caption, fontsize=8, color=edge, loc="center")
        reach = np.linspace(-1.2, 1.2, 81) * max(size, NARROWEST * track.width) / track.radius
        wall_and_edge(axes, track, track.radius - stable.distances[row], reach, (2.2, 1.0), 0.12 * size)
        polygon(axes, turned(posture.outline, heading) / MM, edgecolor=edge)
        polygon(axes, turned(posture.contact, heading) / MM, CONTACT, alpha=0.25, linewidth=1.0, zorder=3)
        axes.plot(*(stable.touching[row] / MM).T, "o", color=style.ACCENT, markersize=5, zorder=5)
        end = 0.6 * size / MM * np.array([np.cos(heading), np.sin(heading)])
        arrow = {"arrowstyle": "-|>", "color": style.INK, "linewidth": 1.0, "shrinkA": 0}
        axes.annotate("", end, (0, 0), arrowprops=arrow, zorder=4)
        shading.centre_of_mass(axes, 0.05 * size / MM)
        high = 1.15 * size / MM
        top = max(high, (track.width - size) / MM * 1.05)
        wide = max(high, NARROWEST * top)  # beside a wide track a small part has few numbers below it
        axes.set(xlim=(-wide, wide), ylim=(-1.3 * size / MM, top))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(mpl_ticker.MaxNLocator(4))  # numbers stand apart
        axes.set_aspect("equal")
    for axes in panels[count:]:
        axes.set_visible(False)
    figure.supxlabel("along the track [mm]", fontsize=9, color=style.INK)
    figure.supylabel("away from the wall [mm]", fontsize=9, color=style.INK)
    return figure


HEADINGS_VIEW = RecordView(headings_text, offers, "headings")
