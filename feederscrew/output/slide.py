"""Files of ``feeder slide``: maps of regimes."""

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document, Frame, of_records
from feederscrew.base.heavy import heavy
from feederscrew.bowl import texts
from feederscrew.bowl.reading import SETTING_COLUMNS, Setting
from feederscrew.motion.limits import Regime
from feederscrew.motion.slide import SlideMap, SlideStudy
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import slide_text
from feederscrew.output.tables import regime_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

matplotlib = heavy("matplotlib")
mpl_colors = heavy("matplotlib.colors")
mpl_patches = heavy("matplotlib.patches")
ndimage = heavy("scipy.ndimage")

LIMIT_LABELS = {  # what a summary says of each map, in this order
    "mu_limit": "limiting friction, level floor [4.27]",
    "mu_forward": "friction that stops slipping forward",
    "mu_backward": "friction that stops slipping back",
    "throw_number": "throw number (hops above 1)",
}
ONSETS = {
    "forward": "G at which it slips forward",
    "backward": "G at which it slips back",
    "hop": "G at which it hops",
}
MAP_SHAPE = (721, 601)  # cells of a map that is drawn
ANGLE = "α − θ, from heading to drive [deg]"
RATIO = "acceleration ratio G = A ω² / g [1]"
FRICTION = "limiting friction μ [1]"
HIGHEST = 2.0  # [1] friction at which pictures are cut: hardly any pair has more
LEVELS = (0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 4.0)  # [1] of the contour lines
SLIDE_COLOURS: dict[str, str] = {  # what a designer wants is the strongest; a hop is hatched as well
    Regime.STICK: "#eef2f5",
    Regime.FORWARD: "#79bfa4",
    Regime.BACKWARD: "#e3a08a",
    Regime.BOTH: "#f3dfae",
    Regime.HOP: "#e1e5e8",
}
LETTER = (0.0125, 0.055)  # width of a letter and height of a line, over the picture's
LEVEL_COLOURS = "cividis"
OWN_LABEL = "this bowl"
LABEL: style.Look = {"fontsize": 8.5, "color": style.INK, "zorder": 4, "ha": "center", "va": "center"}


def printed(study: SlideStudy, format: str) -> Frame:
    """Return what a format prints of a map of slip: every cell as CSV, a summary for people.

    Parameters
    ----------
    study : SlideStudy
    format : str
        'csv' or 'table'.

    Returns
    -------
    Frame
    """
    return _cells(study.maps) if format == "csv" else summary(study.maps)


def _cells(slides: Sequence[SlideMap]) -> Frame:
    parts = []
    for slide_map in slides:
        columns = slide_map.grid.columns()
        count = len(columns["regime"])
        parts.append({"beta_deg": np.full(count, np.degrees(slide_map.beta)), **columns})
    return Frame.of({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def summary(slides: Sequence[SlideMap]) -> Frame:
    """Return what holds at the bowl's own point, for people.

    Parameters
    ----------
    slides : sequence of SlideMap

    Returns
    -------
    Frame
        A column for each map.
    """
    shares = (f"share of the map: {regime_words(name)}" for name in slides[0].grid.names)
    names = ["acceleration ratio G = A w2/g", "alpha - theta [deg]", "static friction"]
    names += [*LIMIT_LABELS.values(), *ONSETS.values(), "regime", *shares]
    columns: dict[str, list[str]] = {"at the bowl's own point": names}
    for one_map in slides:
        numbers = [one_map.ratio, np.degrees(one_map.alpha_minus_theta), one_map.friction]
        numbers += [one_map.at_bowl[name] for name in LIMIT_LABELS]
        numbers += [one_map.onsets[name] for name in ONSETS]
        cells = ["none" if np.isnan(x) else "never" if np.isinf(x) else f"{x:.4g}" for x in numbers]
        cells.append(regime_words(one_map.regime))
        for share in one_map.grid.shares().values():
            cells.append("< 1 %" if 0.0 < share < 0.005 else f"{100 * share:.0f} %")
        columns[f"beta = {np.degrees(one_map.beta):.6g} deg"] = cells
    return Frame.of(columns)


def document(study: SlideStudy) -> Document:
    """Return maps of slip as the JSON document.

    Parameters
    ----------
    study : SlideStudy

    Returns
    -------
    dict
    """
    maps = [
        {
            "beta_deg": np.degrees(slide_map.beta),
            "operating_point": {
                "acceleration_ratio": slide_map.ratio,
                "alpha_minus_theta_deg": np.degrees(slide_map.alpha_minus_theta),
                "static_friction": slide_map.friction,
                **slide_map.at_bowl,
                "regime": slide_map.regime,
            },
            "onset_ratios": slide_map.onsets,
            "shares": slide_map.grid.shares(),
            "cells": slide_map.grid.columns(),
        }
        for slide_map in study.maps
    ]
    return {"bowl": texts(study.bowl.settings), "as_published": study.as_published, "maps": maps}


def remarks(study: SlideStudy) -> list[str]:
    """Return what a reader of maps of slip should know, a sentence each.

    Parameters
    ----------
    study : SlideStudy

    Returns
    -------
    list of str
    """
    lines = []
    for slide_map in study.maps:
        shares, beta = slide_map.grid.shares(), f"beta = {np.degrees(slide_map.beta):.6g} deg"
        empty, cells = slide_map.grid.unanswered("mu_limit"), slide_map.grid.codes.size
        if shares[Regime.HOP] == 0.0:
            lines.append(f"{beta}: the drive does not lift the part, so no cell hops.")
        if shares[Regime.STICK] + shares[Regime.HOP] == 1.0:
            lines.append(f"{beta}: nothing slips before it hops at static friction {slide_map.friction:g}.")
        if empty:
            lines.append(
                f"{beta}: mu_limit is empty in {empty} of {cells} cells, "
                "where no friction prevents forward slip (part hops)."
            )
    return lines


def settings(bowl_settings: Sequence[Setting]) -> Frame:
    """Return the bowl settings and where each came from, as a frame.

    Parameters
    ----------
    bowl_settings : sequence of Setting

    Returns
    -------
    Frame
        A row for each.
    """
    return of_records(SETTING_COLUMNS, bowl_settings)


def offers(study: SlideStudy) -> list[offer.Offer]:
    """Offer the files of maps of slip.

    Parameters
    ----------
    study : SlideStudy

    Returns
    -------
    list of Offer
    """
    fine = cache(partial(study.fine, MAP_SHAPE))  # once for all pictures
    draws = {
        "surface": (surface, "Limiting friction over the heading and the acceleration ratio"),
        "contours": (contours, "Lines of equal limiting friction"),
        "regimes": (regimes, "Regimes of a part over its heading and the acceleration ratio"),
    }

    def draw_fine(draw: Callable[..., "Figure"], place: int, ax: "Axes | None" = None) -> "Figure":
        return draw(fine()[place]) if ax is None else draw(fine()[place], ax)

    pictures = [
        offer.picture(f"slide_{kind}_beta{np.degrees(slide_map.beta):.6g}.png", alt, draw_fine, draw, place)
        for place, slide_map in enumerate(study.maps)
        for kind, (draw, alt) in draws.items()
    ]
    alt = "Limiting friction of an aligned part"
    pictures.append(offer.picture("slide_curves.png", alt, lambda ax=None: curves(fine(), ax)))
    return [offer.table("slide.csv", _cells, study.maps), *pictures]


def surface(slide: SlideMap) -> "Figure":
    """Draw limiting friction [4.27] over (alpha - theta, G), as Figures 5-2 to 5-4, up to friction 2.

    Parameters
    ----------
    slide : SlideMap

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.figure(6.4, 5.2)
    axes: Any = figure.add_subplot(projection="3d", computed_zorder=False)
    angles, ratios, friction = slide.sheet(HIGHEST)
    axes.plot_surface(
        np.degrees(angles),
        ratios,
        friction,
        cmap=LEVEL_COLOURS,
        vmin=0.0,
        vmax=HIGHEST,
        rcount=61,
        ccount=61,
        edgecolor="white",
        linewidth=0.15,
        zorder=1,
    )
    own = slide.level_line(slide.friction, angles[:, 0])
    own = np.where(own <= ratios.max(), own, np.nan)
    label = f"static friction of this bowl, {slide.friction:g}: where the surface is above it, the part slips"
    look = {"color": style.ACCENT, "linewidth": 1.8, "zorder": 3, "label": label}
    axes.plot(np.degrees(angles[:, 0]), own, slide.friction, **look)
    title = f"Limiting friction, β = {np.degrees(slide.beta):.6g}°"
    style.tidy(axes, title=title, x=ANGLE, y="G = A ω² / g [1]", grid="none")
    axes.set_zlabel(FRICTION, fontsize=9, color=style.INK)
    axes.set(xlim=(-90, 90), ylim=(0, ratios.max()), zlim=(0, HIGHEST), xticks=np.arange(-90, 91, 30))
    axes.tick_params(labelsize=8, colors=style.INK)
    axes.set_box_aspect((1.25, 1.0, 0.8), zoom=1.0)
    axes.view_init(elev=28, azim=-118)
    axes.legend(loc="upper left", bbox_to_anchor=(-0.01, 1.0), **style.LEGEND)
    return figure


def contours(slide: SlideMap, ax: "Axes | None" = None) -> "Figure":
    """Draw lines of equal limiting friction [4.27], as Figure 5-5, with the hop and the bowl's own point.

    Parameters
    ----------
    slide : SlideMap
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _map_axes(slide, "Limiting friction", ax)
    friction = slide.grid.values["mu_limit"]
    x, y = slide.grid.first.in_unit, slide.grid.second.values
    # contour lines, each with its value written at an angle: those that the map reaches
    lines = {
        level: (shade, 1.1, (-22, -40)[place % 2], f"μ = {level:g}")
        for place, (level, shade) in enumerate(zip(LEVELS, _shades(len(LEVELS))))
        if abs(level - slide.friction) > 0.1 * level  # the bowl's own friction takes the place of a near one
    }
    lines[slide.friction] = (style.ACCENT, 1.8, 60, f"{OWN_LABEL}'s μ = {slide.friction:g}")
    levels = [level for level in sorted(lines) if np.nanmin(friction) < level < np.nanmax(friction)]
    if levels:
        colours, widths, degrees, names = zip(*(lines[level] for level in levels))
        drawn = axes.contour(x, y, friction.T, levels, colors=colours, linewidths=widths)
        places = [(at, slide.level_line(level, np.radians(at))) for level, at in zip(levels, degrees)]
        named = [place for place in places if place[1] < y[-1]]
        labels = axes.clabel(drawn, fmt=dict(zip(levels, names)), fontsize=7, manual=named) if named else ()
        for text in labels:
            if not text.get_text().startswith(OWN_LABEL):
                text.set_color(style.INK)
    _hop_region(axes, slide, slide.level_hop)
    return figure


def regimes(slide: SlideMap, ax: "Axes | None" = None) -> "Figure":
    """Draw what the bowl's own friction allows in each cell, with the bowl's own point.

    Parameters
    ----------
    slide : SlideMap
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _map_axes(slide, f"Regimes at static friction {slide.friction:g}", ax)
    widest, top = axes.get_xlim()[1], axes.get_ylim()[1]
    shades = mpl_colors.to_rgba_array([SLIDE_COLOURS[name] for name in slide.grid.names])
    cells = (255.0 * shades).round().astype(np.uint8)[slide.grid.codes.T]
    look: style.Look = {"interpolation": "none", "origin": "lower", "aspect": "auto"}
    axes.imshow(cells, extent=(-widest, widest, 0, top), **look)
    _hop_region(axes, slide, slide.onsets["hop"])
    # colours of the regimes that are on the map but too thin to be named there
    unlabelled = [
        name for name in slide.grid.names if name != Regime.HOP and not _label_region(axes, slide, name)
    ]
    shares = slide.grid.shares()
    patches = [
        mpl_patches.Patch(color=SLIDE_COLOURS[name], label=regime_words(name))
        for name in unlabelled
        if shares[name] > 0
    ]
    if patches:
        style.legend(figure, "lower left", ax=ax, handles=patches, ncols=len(patches))
    return figure


def curves(slides: Sequence[SlideMap], ax: "Axes | None" = None) -> "Figure":
    """Draw limiting friction of a part aligned with the drive over G, as Figure 5-1; [4.28].

    Parameters
    ----------
    slides : sequence of SlideMap
        A curve for each.
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    first, title = slides[0], "Limiting friction of an aligned part, α = θ"
    figure, axes = style.chart(6.4, 4.2, ax=ax, title=title, x=RATIO, y=FRICTION)
    for slide, shade in zip(slides, _shades(len(slides))):  # forward limit [4.28] and, dashed, backward limit
        aligned, ratios = np.abs(slide.grid.first.values).argmin(), slide.grid.second.values
        forward, backward = (slide.grid.values[name][aligned] for name in ("mu_limit", "mu_backward"))
        label = f"β = {np.degrees(slide.beta):.6g}°"
        axes.plot(ratios, forward, color=shade, linewidth=1.8, label=label)
        axes.plot(ratios, backward, color=shade, linewidth=1.0, linestyle="--")
    axes.axhline(first.friction, color=style.ACCENT, linewidth=1.0, alpha=0.7)
    axes.plot([], [], color=style.INK, linestyle="--", linewidth=1.0, label="slips back, this track")
    # as far as shows every curve up to the cut, and the bowl's own point
    cuts = [float(slide.level_line(HIGHEST, np.array(0.0))) for slide in slides]
    axes.set(xlim=(0, 1.1 * max([*cuts, first.ratio])), ylim=(0, HIGHEST))
    own = f"this bowl, G = {first.ratio:.3g}, μ = {first.friction:g}"
    _note_point(axes, (first.ratio, first.friction), own, drop=9)
    axes.plot([], [], color=style.ACCENT, linewidth=1.0, alpha=0.7, marker="o", label=OWN_LABEL)
    style.legend(figure, "lower left", ax=ax, ncols=min(len(slides), 3) + 1, labelcolor=style.INK)
    return figure


def _map_axes(slide: SlideMap, title: str, ax: "Axes | None") -> tuple["Figure", "Axes"]:
    title = f"{title}, β = {np.degrees(slide.beta):.6g}°"
    figure, axes = style.chart(6.4, 4.6, ax=ax, title=title, x=ANGLE, y=RATIO, grid="none")
    widest = slide.grid.first.in_unit[-1]
    axes.set(xlim=(-widest, widest), ylim=(0, slide.grid.second.values[-1]))
    axes.set_xticks(np.linspace(-widest, widest, 7))
    _note_point(axes, (np.degrees(slide.alpha_minus_theta), slide.ratio), f"this bowl, G = {slide.ratio:.3g}")
    return figure, axes


def _hop_region(axes: "Axes", slide: SlideMap, start: float) -> None:
    """Grey hatching from a G upward, where contact is lost, with its name."""
    top = slide.grid.second.values[-1]
    if start >= top:
        return
    with matplotlib.rc_context({"hatch.color": "#b4bcc3", "hatch.linewidth": 0.5}):
        axes.axhspan(start, top, facecolor=SLIDE_COLOURS[Regime.HOP], hatch="////", linewidth=0, zorder=1.5)
    axes.axhline(start, color=style.INK, linewidth=1.0, zorder=1.6)
    x = -0.5 * axes.get_xlim()[1] if slide.ratio > start else 0.0  # beside the bowl's own point
    text = "no friction prevents forward slip (part hops)"
    axes.text(x, (start + top) / 2, text, path_effects=style.halo(), **LABEL)


def _note_point(axes: "Axes", place: tuple[float, float], text: str, drop: float = 0) -> None:
    """Mark the bowl's own point, its text on the side that has room."""
    left = place[0] <= np.mean(axes.get_xlim())
    shift, side = (8 if left else -8, -drop), "left" if left else "right"
    style.own_point(axes, place, text, shift, ha=side, va="center")


def _label_region(axes: "Axes", slide: SlideMap, name: str) -> bool:
    """Write the regime's name into its region, on two lines if need be; False if it has no room."""
    angles, ratios = np.asarray(slide.grid.first.in_unit), np.asarray(slide.grid.second.values)
    # cells that the bowl's own point and its name, which is on either side, lie over
    across = (angles - np.degrees(slide.alpha_minus_theta)) / np.ptp(angles)
    across = np.abs(across) if slide.alpha_minus_theta > 0.0 else across
    up = np.abs(ratios - slide.ratio) / np.ptp(ratios)
    taken = ((across > -0.02) & (across < 0.27))[:, None] & (up < 0.03)
    inside = (slide.grid.codes == slide.grid.names.index(name)) & ~taken
    for text in (regime_words(name), regime_words(name).replace(" ", "\n", 1)):
        lines = text.split("\n")
        sizes = (LETTER[0] * max(map(len, lines)), LETTER[1] * len(lines))
        box = tuple(int(size * count) for size, count in zip(sizes, inside.shape))
        room = ndimage.minimum_filter(inside, size=box, mode="constant", cval=False)
        if room.any():
            # the cell deepest in the region; among nearly as deep ones, the nearest to the middle
            depth = ndimage.distance_transform_edt(np.pad(room, 1))[1:-1, 1:-1]
            i, j = np.nonzero(depth >= 0.9 * depth.max())
            best = np.abs(i - room.shape[0] // 2).argmin()
            same = np.flatnonzero(i == i[best])
            x, y = angles[i[best]], ratios[j[same[len(same) // 2]]]
            axes.text(x, y, text, path_effects=style.halo(), **LABEL)
            return True
    return False


def _shades(count: int) -> Floats:
    return matplotlib.colormaps[LEVEL_COLOURS](np.linspace(0.05, 0.8, count))


SLIDE_VIEW = RecordView(slide_text, offers, "slide")
