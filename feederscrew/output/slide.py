"""Files of ``feeder slide``: maps of regimes."""

from functools import cache, partial
from typing import Any

import numpy as np

from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.words import regime_words

matplotlib = heavy("matplotlib")
mpl_colors = heavy("matplotlib.colors")
mpl_patches = heavy("matplotlib.patches")
ndimage = heavy("scipy.ndimage")

LIMITS = {  # what a summary says of each map, in this order
    "mu_limit": "limiting friction, level floor [4.27]",
    "mu_forward": "friction that stops forward slip",
    "mu_backward": "friction that stops backward slip",
    "throw_number": "throw number (hops above 1)",
}
ONSETS = {"forward": "G of forward slip", "backward": "G of backward slip", "hop": "G of the hop"}


def printed(study, format):
    """Return what a format prints of a SlideStudy: every cell as CSV, a summary for people."""
    return cells(study.maps) if format == "csv" else summary(study.maps)


def cells(slides):
    """Return every cell of every SlideMap, as a frame."""
    parts = []
    for one in slides:
        columns = one.grid.columns()
        count = len(columns["regime"])
        parts.append({"beta_deg": np.full(count, np.degrees(one.beta)), **columns})
    return tables.frame({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def summary(slides):
    """Return what holds at the bowl's own point, a column a map, as a frame for people."""
    first = slides[0]
    names = ["acceleration ratio G = A w2/g", "alpha - theta [deg]", "static friction", *LIMITS.values()]
    names += [
        *ONSETS.values(),
        "regime",
        *(f"share of the map: {regime_words(name)}" for name in first.grid.names),
    ]
    columns = {f"beta = {np.degrees(one.beta):.6g} deg": _column(one) for one in slides}
    return tables.frame({"at the bowl's own point": names, **columns})


def document(study, settings) -> dict[Any, Any]:
    """Return a SlideStudy as the JSON document.

    Parameters
    ----------
    study : SlideStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    dict
    """
    maps = [_map(one) for one in study.maps]
    return {"bowl": settings, "as_published": study.as_published, "maps": maps}


def remarks(study):
    """Return what a reader of a SlideStudy should know, a sentence each."""
    lines = []
    for one in study.maps:
        shares, beta = one.grid.shares(), f"beta = {np.degrees(one.beta):.6g} deg"
        empty, cells = one.grid.unanswered("mu_limit"), one.grid.codes.size
        if shares["hop"] == 0.0:
            lines.append(f"{beta}: the drive does not lift the part, so no cell hops.")
        if shares["stick"] + shares["hop"] == 1.0:
            lines.append(f"{beta}: nothing slips before it hops at static friction {one.friction:g}.")
        if empty:
            lines.append(
                f"{beta}: mu_limit is empty in {empty} of {cells} cells, "
                "where no friction prevents forward slip (part hops)."
            )
    return lines


def settings(found):
    """Return the bowl settings and where each came from, as a frame."""
    columns = {
        "key": [s.key.name for s in found],
        "value": [s.text for s in found],
        "from": [s.origin for s in found],
        "lowest": [s.key.lowest for s in found],
        "highest": [s.key.highest for s in found],
        "meaning": [s.key.meaning for s in found],
    }
    return tables.frame(columns)


def _map(one) -> dict[Any, Any]:
    return {
        "beta_deg": np.degrees(one.beta),
        "operating_point": {
            "acceleration_ratio": one.ratio,
            "alpha_minus_theta_deg": np.degrees(one.alpha_minus_theta),
            "static_friction": one.friction,
            **one.at_bowl,
            "regime": one.regime,
        },
        "onset_ratios": one.onsets,
        "shares": one.grid.shares(),
        "cells": one.grid.columns(),
    }


def _column(one) -> list[Any]:
    numbers = [one.ratio, np.degrees(one.alpha_minus_theta), one.friction]
    numbers += [one.at_bowl[name] for name in LIMITS] + [one.onsets[name] for name in ONSETS]
    shares = [_percent(share) for share in one.grid.shares().values()]
    return [*(_number(number) for number in numbers), regime_words(one.regime), *shares]


def _number(value) -> str:
    if np.isnan(value):
        return "none"
    return "never" if np.isinf(value) else f"{value:.4g}"


def _percent(share) -> str:
    return "< 1 %" if 0.0 < share < 0.005 else f"{100 * share:.0f} %"


ANGLE = "α − θ, from heading to drive [deg]"
RATIO = "acceleration ratio G = A ω² / g [1]"
FRICTION = "limiting friction μ [1]"
HIGHEST = 2.0  # [1] friction at which pictures are cut: hardly any pair has more
LEVELS = (0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 4.0)  # [1] of the contour lines
NEAR = 0.1  # [1] of a level: the bowl's own friction, nearer than that, takes its place
REGIMES = {  # colour and label; what a designer wants is the strongest
    "stick": ("#eef2f5", "sticks"),
    "forward": ("#79bfa4", "slips forward only"),
    "backward": ("#e3a08a", "slips back only"),
    "both": ("#f3dfae", "slips both ways"),
    "hop": ("#e1e5e8", "hops"),
}
HATCH = "#b4bcc3"
LETTER = (0.0125, 0.055)  # width of a letter and height of a line, over the picture's
SHADES = "cividis"
OWN = "this bowl"
LABEL = {"fontsize": 8.5, "color": style.INK, "zorder": 4}


def surface(slide):
    """Draw limiting friction [4.27] over (alpha - theta, G), as Figures 5-2 to 5-4, up to friction 2.

    Parameters
    ----------
    slide : SlideMap

    Returns
    -------
    Figure
    """
    figure = style.figure(6.4, 5.2)
    axes = figure.add_subplot(projection="3d", computed_zorder=False)
    angles, ratios, friction = slide.sheet(HIGHEST)
    axes.plot_surface(
        np.degrees(angles), ratios, friction, cmap=SHADES, vmin=0.0, vmax=HIGHEST,
        rcount=61, ccount=61, edgecolor="white", linewidth=0.15, zorder=1,
    )  # fmt: skip
    own = slide.level_line(slide.friction, angles[:, 0])
    own = np.where(own <= ratios.max(), own, np.nan)
    label = f"static friction of this bowl, {slide.friction:g}: where the surface is above it, the part slips"
    axes.plot(
        np.degrees(angles[:, 0]),
        own,
        slide.friction,
        color=style.ACCENT,
        linewidth=1.8,
        zorder=3,
        label=label,
    )
    _dress_3d(axes, slide, ratios.max())
    axes.legend(
        fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(-0.01, 1.0), labelcolor=style.INK
    )
    return figure


def contours(slide):
    """Draw lines of equal limiting friction [4.27], as Figure 5-5, with the hop and the bowl's own point.

    Parameters
    ----------
    slide : SlideMap
        Of many cells.

    Returns
    -------
    Figure
    """
    figure, axes = _map_axes(slide, "Limiting friction")
    _levels(axes, slide)
    _hop_region(axes, slide, slide.level_hop)
    _own_point(axes, np.degrees(slide.alpha_minus_theta), slide.ratio, f"this bowl, G = {slide.ratio:.3g}")
    return figure


def regimes(slide):
    """Draw what the bowl's own friction allows in each cell, with the bowl's own point.

    Parameters
    ----------
    slide : SlideMap
        Of many cells.

    Returns
    -------
    Figure
    """
    figure, axes = _map_axes(slide, f"Regimes at static friction {slide.friction:g}")
    widest, top = axes.get_xlim()[1], axes.get_ylim()[1]
    colours = (
        (255.0 * mpl_colors.to_rgba_array([REGIMES[name][0] for name in slide.grid.names]))
        .round()
        .astype(np.uint8)
    )
    axes.imshow(
        colours[slide.grid.codes.T], interpolation="none", origin="lower", aspect="auto",
        extent=(-widest, widest, 0, top),
    )  # fmt: skip
    _hop_region(axes, slide, slide.onsets["hop"])
    unlabelled = [name for name in slide.grid.names if name != "hop" and not _label_region(axes, slide, name)]
    _legend(figure, slide, unlabelled)
    _own_point(axes, np.degrees(slide.alpha_minus_theta), slide.ratio, f"this bowl, G = {slide.ratio:.3g}")
    return figure


def curves(slides):
    """Draw limiting friction of a part aligned with the drive over G, as Figure 5-1; [4.28].

    Parameters
    ----------
    slides : sequence of SlideMap
        One a vibration angle.

    Returns
    -------
    Figure
    """
    figure = style.figure(6.4, 4.2)
    axes = style.tidy(
        figure.add_subplot(), title="Limiting friction of an aligned part, α = θ", x=RATIO, y=FRICTION
    )
    for slide, shade in zip(slides, _shades(len(slides))):
        _curve(axes, slide, shade)
    first = slides[0]
    axes.axhline(first.friction, color=style.ACCENT, linewidth=1.0, alpha=0.7)
    axes.plot([], [], color=style.INK, linestyle="--", linewidth=1.0, label="backward slip, this track")
    axes.set(xlim=(0, _right_edge(slides)), ylim=(0, HIGHEST))
    _own_point(
        axes, first.ratio, first.friction, f"this bowl, G = {first.ratio:.3g}, μ = {first.friction:g}", drop=9
    )
    axes.plot([], [], color=style.ACCENT, linewidth=1.0, alpha=0.7, marker="o", label=OWN)
    figure.legend(
        fontsize=8,
        frameon=False,
        loc="outside lower left",
        labelcolor=style.INK,
        ncols=min(len(slides), 3) + 1,
    )
    return figure


def _map_axes(slide, title) -> tuple[Any, ...]:
    figure = style.figure(6.4, 4.6)
    title = f"{title}, β = {np.degrees(slide.beta):.6g}°"
    axes = style.tidy(figure.add_subplot(), title=title, x=ANGLE, y=RATIO, grid="none")
    widest = slide.grid.first.shown[-1]
    axes.set(xlim=(-widest, widest), ylim=(0, slide.grid.second.values[-1]))
    axes.set_xticks(np.linspace(-widest, widest, 7))
    return figure, axes


def _hop_region(axes, slide, start) -> None:
    """Grey hatching from a G upward, where contact is lost, with its name."""
    top = slide.grid.second.values[-1]
    if start >= top:
        return
    with matplotlib.rc_context({"hatch.color": HATCH, "hatch.linewidth": 0.5}):
        axes.axhspan(start, top, facecolor=REGIMES["hop"][0], hatch="////", linewidth=0, zorder=1.5)
    axes.axhline(start, color=style.INK, linewidth=1.0, zorder=1.6)
    x = -0.5 * axes.get_xlim()[1] if slide.ratio > start else 0.0  # beside the bowl's own point
    axes.text(
        x,
        (start + top) / 2,
        "no friction prevents forward slip (part hops)",
        ha="center",
        va="center",
        path_effects=style.halo(),
        **LABEL,
    )


def _own_point(axes, x, y, text, drop=0) -> None:
    """The bowl's own operating point, named beside it."""
    axes.plot(x, y, "o", markersize=7, color=style.ACCENT, markeredgecolor="white", zorder=5)
    left = x <= np.mean(axes.get_xlim())
    axes.annotate(
        text, (x, y), (8 if left else -8, -drop), textcoords="offset points", ha="left" if left else "right",
        va="center", fontsize=8, color=style.ACCENT, fontweight="bold", zorder=6,
        bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 1.0},
    )  # fmt: skip


def _label_region(axes, slide, name) -> bool:
    """Write the regime's name into its region, on two lines if need be; False if it has no room."""
    inside = (slide.grid.codes == slide.grid.names.index(name)) & ~_taken(slide)
    for text in (REGIMES[name][1], REGIMES[name][1].replace(" ", "\n", 1)):
        lines = text.split("\n")
        box = (
            int(LETTER[0] * max(map(len, lines)) * inside.shape[0]),
            int(LETTER[1] * len(lines) * inside.shape[1]),
        )
        room = ndimage.minimum_filter(inside, size=box, mode="constant", cval=False)
        if room.any():
            i, j = _most_central(room)
            x, y = slide.grid.first.shown[i], slide.grid.second.values[j]
            axes.text(x, y, text, ha="center", va="center", path_effects=style.halo(), **LABEL)
            return True
    return False


def _taken(slide):
    """Cells that the bowl's own point and its name lie over."""
    angles, ratios = slide.grid.first.shown, slide.grid.second.values
    across = (np.asarray(angles) - np.degrees(slide.alpha_minus_theta)) / np.ptp(angles)
    across = np.abs(across) if slide.alpha_minus_theta > 0.0 else across  # the name is on either side
    up = np.abs(np.asarray(ratios) - slide.ratio) / np.ptp(ratios)
    return ((across > -0.02) & (across < 0.27))[:, None] & (up < 0.03)


def _most_central(room) -> tuple[Any, ...]:
    """The cell deepest in a region; among nearly as deep ones, the nearest to the middle."""
    depth = ndimage.distance_transform_edt(np.pad(room, 1))[1:-1, 1:-1]
    i, j = np.nonzero(depth >= 0.9 * depth.max())
    best = np.abs(i - room.shape[0] // 2).argmin()
    same = np.flatnonzero(i == i[best])
    return i[best], j[same[len(same) // 2]]


def _legend(figure, slide, names) -> None:
    """Colours of the regimes that are on the map but too thin to be named there."""
    shares = slide.grid.shares()
    patches = [mpl_patches.Patch(color=REGIMES[n][0], label=REGIMES[n][1]) for n in names if shares[n] > 0]
    if patches:
        figure.legend(
            handles=patches, loc="outside lower left", ncols=len(patches), fontsize=8, frameon=False
        )


def _levels(axes, slide) -> None:
    """Contour lines, each with its value written at an angle: those that the map reaches."""
    friction = slide.grid.values["mu_limit"]
    x, y = slide.grid.first.shown, slide.grid.second.values
    lines = {
        level: (shade, 1.1, (-22, -40)[place % 2], f"μ = {level:g}")
        for place, (level, shade) in enumerate(zip(LEVELS, _shades(len(LEVELS))))
        if abs(level - slide.friction) > NEAR * level
    }
    lines[slide.friction] = (style.ACCENT, 1.8, 60, f"{OWN}'s μ = {slide.friction:g}")
    levels = [level for level in sorted(lines) if np.nanmin(friction) < level < np.nanmax(friction)]
    if not levels:
        return
    colours, widths, degrees, texts = zip(*(lines[level] for level in levels))
    drawn = axes.contour(x, y, friction.T, levels, colors=colours, linewidths=widths)
    places = [(at, slide.level_line(level, np.radians(at))) for level, at in zip(levels, degrees)]
    named = [place for place in places if place[1] < y[-1]]
    if named:
        for text in axes.clabel(drawn, fmt=dict(zip(levels, texts)), fontsize=7, manual=named):
            if not text.get_text().startswith(OWN):
                text.set_color(style.INK)


def _dress_3d(axes, slide, top) -> None:
    title = f"Limiting friction, β = {np.degrees(slide.beta):.6g}°"
    style.tidy(axes, title=title, x=ANGLE, y="G = A ω² / g [1]", grid="none")
    axes.set_zlabel(FRICTION, fontsize=9, color=style.INK)
    axes.set(xlim=(-90, 90), ylim=(0, top), zlim=(0, HIGHEST), xticks=np.arange(-90, 91, 30))
    axes.tick_params(labelsize=8, colors=style.INK)
    axes.set_box_aspect((1.25, 1.0, 0.8), zoom=1.0)
    axes.view_init(elev=28, azim=-118)


def _curve(axes, slide, shade) -> None:
    """One angle: its forward limit [4.28] and, dashed, its backward limit."""
    aligned, ratios = np.abs(slide.grid.first.values).argmin(), slide.grid.second.values
    forward, backward = (slide.grid.values[name][aligned] for name in ("mu_limit", "mu_backward"))
    axes.plot(ratios, forward, color=shade, linewidth=1.8, label=f"β = {np.degrees(slide.beta):.6g}°")
    axes.plot(ratios, backward, color=shade, linewidth=1.0, linestyle="--")


def _right_edge(slides):
    """G that shows every curve up to the cut, and the bowl's own point."""
    cuts = [float(slide.level_line(HIGHEST, 0.0)) for slide in slides]
    return 1.1 * max([*cuts, slides[0].ratio])


def _shades(count):
    return matplotlib.colormaps[SHADES](np.linspace(0.05, 0.8, count))


PICTURE = (721, 601)  # cells of a map that is drawn
ALTS = {
    "surface": "Limiting friction over the heading and the acceleration ratio",
    "contours": "Lines of equal limiting friction",
    "regimes": "Regimes of a part over its heading and the acceleration ratio",
}


def offers(study) -> list[Any]:
    """Offer the files of a SlideStudy, as a list of Offer."""
    fine = cache(partial(study.fine, PICTURE))  # once for all pictures
    pictures = [
        offer.picture(f"slide_{kind}_beta{np.degrees(one.beta):.6g}.png", alt, _draw, kind, fine, place)
        for place, one in enumerate(study.maps)
        for kind, alt in ALTS.items()
    ]
    return [
        offer.table("slide.csv", cells, study.maps),
        *pictures,
        offer.picture("slide_curves.png", "Limiting friction of an aligned part", _curves, fine),
    ]


def _draw(kind, fine, place):
    draw = {"surface": surface, "contours": contours, "regimes": regimes}[kind]
    return draw(fine()[place])


def _curves(fine):
    return curves(fine())
