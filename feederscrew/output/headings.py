"""Files of ``feeder headings``."""

from typing import Any

import numpy as np

from feederscrew.bowl import texts
from feederscrew.geometry.polygons import turned
from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.floor import CONTACT, PART
from feederscrew.part.record import small_part_remarks
from feederscrew.studies.headings import HeadingsStudy
from feederscrew.units import MM

mpl_patches = heavy("matplotlib.patches")
mpl_ticker = heavy("matplotlib.ticker")
shading = heavy("feederscrew.output.shading")

HIDDEN_HEADING_COLUMNS = ("contact_1_x_mm", "contact_1_y_mm", "contact_2_x_mm", "contact_2_y_mm")
SPARE_COLUMNS = (
    ("straight_wall_share",),
    ("half_turn_of_deg", "mirror_of_deg"),
)  # left out of a table that is too wide


def rows(study) -> list[Any]:
    """Return every stable heading of a HeadingsStudy, one a dict, under the columns of ``headings.csv``."""
    return [
        _row(stable, row, study.chances) for stable in study.headings for row in range(len(stable.headings))
    ]


def frame(study):
    """Return the rows of a HeadingsStudy as a frame."""
    listed = rows(study)
    return tables.frame({name: [row[name] for row in listed] for name in listed[0]})


def document(study: HeadingsStudy) -> dict[str, Any]:
    """Return a HeadingsStudy as the JSON document."""
    return {
        "part": study.part.name,
        "answer": study.answer,
        "headings": rows(study),
        "bowl": texts(study.bowl.settings),
    }


def answer(study) -> str:
    """Say whose probabilities of the aspects a HeadingsStudy takes."""
    return f"Aspect share: {study.answer}"


def remarks(study):
    """Return what a reader of a HeadingsStudy should know, a sentence each."""
    lines, width = list(small_part_remarks(study.part, {}, study.track.width)), study.track.width / MM
    for stable in study.headings:
        if stable.rounded:
            lines.append(f"aspect {stable.aspect} is round in plan: it takes any heading")
        if stable.falls_off.all():
            lines.append(f"aspect {stable.aspect} falls off the track of {width:.4g} mm in every heading")
    return lines


def _row(stable, row, chances) -> dict[Any, Any]:
    degrees = np.degrees(stable.headings)
    return {
        "aspect": stable.aspect,
        "heading_deg": float(degrees[row]),
        "share": float(stable.shares[row]),
        "straight_wall_share": float(stable.straight_shares[row]),
        "aspect_share": chances.get(stable.aspect, np.nan) * float(stable.shares[row]),
        "length_mm": float(stable.lengths[row]) / MM,
        "width_mm": float(stable.widths[row]) / MM,
        "overhang_mm": float(stable.overhangs[row]) / MM,
        "falls_off": bool(stable.falls_off[row]),
        "half_turn_of_deg": _partner(degrees, stable.half_turns[row]),
        "mirror_of_deg": _partner(degrees, stable.mirrors[row]),
        **{
            f"contact_{k + 1}_{axis}_mm": float(stable.touching[row, k, i]) / MM
            for k in (0, 1)
            for i, axis in enumerate("xy")
        },
    }


def _partner(degrees, place):
    return float(degrees[place]) if place >= 0 else np.nan


PANELS_ACROSS = 4
MAX_PANELS = 16  # headings of one picture, the most frequent
WALL, FALLS = "#5d6b78", "#b5482a"
SIDE = 2.5  # [in] of one picture
NARROWEST = 0.4  # half a picture's width, over its height above the foot
TICKS = 4  # steps of an axis, at most: their numbers stand apart in it


def headings(posture, stable, track, title: str):
    """Draw the part in each stable heading, the wall below, the track's free edge dashed."""
    count = min(len(stable.headings), MAX_PANELS)
    columns = min(PANELS_ACROSS, count)
    lines = -(-count // columns)
    figure = style.figure(max(columns * SIDE, 2 * SIDE), lines * SIDE + 0.6)
    panels = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True).ravel()
    figure.suptitle(title, x=0.01, ha="left", fontsize=10.5, color=style.INK, fontweight="bold")
    size = np.linalg.norm(posture.outline, axis=1).max()
    for row, axes in enumerate(panels[:count]):
        _panel(axes, posture, stable, row, track, size)
    for axes in panels[count:]:
        axes.set_visible(False)
    figure.supxlabel("along the track [mm]", fontsize=9, color=style.INK)
    figure.supylabel("away from the wall [mm]", fontsize=9, color=style.INK)
    return figure


def _panel(axes, posture, stable, row, track, size) -> None:
    heading, falls = stable.headings[row], stable.falls_off[row]
    style.tidy(axes, grid="none")
    axes.set_title(_caption(stable, row), fontsize=8, color=FALLS if falls else style.INK, loc="center")
    _track(axes, stable.distances[row], track, size)
    outline, contact = turned(posture.outline, heading) / MM, turned(posture.contact, heading) / MM
    edge = FALLS if falls else style.INK
    axes.add_patch(
        mpl_patches.Polygon(outline, closed=True, facecolor=PART, edgecolor=edge, linewidth=1.4, zorder=2)
    )
    axes.add_patch(
        mpl_patches.Polygon(contact, closed=True, facecolor=CONTACT, edgecolor=CONTACT, alpha=0.25, zorder=3)
    )
    axes.plot(*(stable.touching[row] / MM).T, "o", color=style.ACCENT, markersize=5, zorder=5)
    end = 0.6 * size / MM * np.array([np.cos(heading), np.sin(heading)])
    axes.annotate(
        "",
        end,
        (0, 0),
        arrowprops={"arrowstyle": "-|>", "color": style.INK, "linewidth": 1.0, "shrinkA": 0},
        zorder=4,
    )
    shading.centre_of_mass(axes, 0.05 * size / MM)
    reach = 1.15 * size / MM
    top = max(reach, (track.width - size) / MM * 1.05)
    wide = max(reach, NARROWEST * top)  # beside a wide track a small part has few numbers below it
    axes.set(xlim=(-wide, wide), ylim=(-1.3 * size / MM, top))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(mpl_ticker.MaxNLocator(TICKS))
    axes.set_aspect("equal")


def _caption(stable, row) -> str:
    text = f"{np.degrees(stable.headings[row]):.4g}°   {100.0 * stable.shares[row]:.1f} %"
    size = f"{stable.lengths[row] / MM:.4g} long, {stable.widths[row] / MM:.4g} wide [mm]"
    note = (
        "falls off" if stable.falls_off[row] else "overhangs" if stable.overhangs[row] > 0.0 else "stays on"
    )
    return f"{text}\n{size}\n{note}"


def _track(axes, distance, track, size) -> None:
    """The wall and the free edge, concentric."""
    reach = np.linspace(-1.2, 1.2, 81) * max(size, NARROWEST * track.width) / track.radius
    for radius, dashes in ((track.radius, "-"), (track.radius - track.width, (0, (5, 3)))):
        x, y = radius * np.sin(reach), track.radius - distance - radius * np.cos(reach)
        axes.plot(
            x / MM, y / MM, color=WALL, linewidth=2.2 if dashes == "-" else 1.0, linestyle=dashes, zorder=1
        )
        if dashes == "-":
            axes.fill_between(x / MM, y / MM, y / MM - 0.12 * size / MM, color=WALL, alpha=0.35, linewidth=0)


def offers(study: HeadingsStudy) -> list[offer.Offer]:
    """Offer the files of a HeadingsStudy."""
    return [
        offer.document("headings.json", document, study),
        offer.table("headings.csv", frame, study),
        *(
            offer.picture(
                f"headings_{posture.name}.png", f"Stable headings of aspect {posture.name} from above",
                _draw, study, place,
            )
            for place, posture in enumerate(study.postures)
        ),
    ]  # fmt: skip


def _draw(study, place):
    posture = study.postures[place]
    title = f"{study.part.name}, aspect {posture.name}: heading, share"
    return headings(posture, study.headings[place], study.track, title)
