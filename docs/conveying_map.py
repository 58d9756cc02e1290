"""Bring the computed parts of docs/conveying.md and docs/method/conveying.md up to date: tables and the map.

Example: python docs/conveying_map.py          (writes both pages, conveying_map.csv and conveying_map.png)
         python docs/conveying_map.py --check  (status 1 if a table or the map's numbers are out of date)
"""

import sys
from pathlib import Path

import generated
import numpy as np

from feederscrew.motion.conveying import sweep
from feederscrew.motion.operating_point import Numbers, plain, with_numbers
from feederscrew.motion.steady import VELOCITY

DOCS = Path(__file__).resolve().parent
METHOD = DOCS / "method/conveying.md"
DEG = np.pi / 180.0
THROWS = np.arange(1.5, 7.8, 0.01)
PEAKS = {"first": (1.5, 4.6), "second": (4.6, 7.8)}
CLIMB = 3.0  # [deg]
ANGLES, FRICTIONS, RESTITUTIONS = (20, 30, 40), (0.2, 0.4, 0.6, 0.8), (0.0, 0.2)
FRICTION = 0.3  # of the settings that stand for their numbers
COUPLINGS = np.geomspace(0.02, 1.0, 25)
MARKS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)  # on the axis of couplings
MAP_THROWS = np.linspace(0.2, 7.0, 35)
STEEPNESSES, REBOUNDS = (0.0, 0.25), (0.0, 0.3)
PHASE_COUPLINGS = (0.035, 0.088, 0.12, 0.18, 0.29, 0.46)
PHASES = np.arange(-180, 180, 1)


def velocities(settings):
    """Velocity over the plate's greatest speed along the track, of a list of settings."""
    rows = np.array(settings)
    return sweep(rows)[:, VELOCITY] / np.cos(rows[:, 1])


def throws():
    """Best throw numbers as a table."""
    lines = ["| restitution | angle | friction | first peak | there | second peak | there | least between |"]
    lines.append("|---" * 8 + "|")
    for restitution in RESTITUTIONS:
        for angle in ANGLES:
            for friction in FRICTIONS:
                lines.append(_row(restitution, angle, friction))
    return "\n".join(lines) + "\n"


def _row(restitution, angle, friction):
    ratios = THROWS * np.cos(CLIMB * DEG) / np.sin(angle * DEG)
    found = velocities([plain(r, angle * DEG, CLIMB * DEG, friction, restitution) for r in ratios])
    peaks = []
    for low, high in PEAKS.values():
        inside = np.flatnonzero((low <= THROWS) & (high > THROWS))
        peaks.append(inside[np.argmax(found[inside])])
    between = found[peaks[0] : peaks[1]].min()
    cells = "".join(f" {THROWS[k]:.1f} | {found[k]:.2f} |" for k in peaks)
    return f"| {restitution:g} | {angle} deg | {friction:g} |{cells} {between:.2f} |"


def phases():
    """Best phase of an elliptical drive on a level track at the throw number 1, as a table."""
    lines = [
        "| mu tan(vibration angle) | best phase | velocity there | with a straight drive |",
        "|---|---|---|---|",
    ]
    for coupling in PHASE_COUPLINGS:
        found = [Numbers(coupling, 0.0, 1.0 - 1e-9, 0.0, phase * DEG) for phase in PHASES]
        speed = velocities([with_numbers(one, FRICTION) for one in found])
        best = int(np.argmax(speed))
        straight = speed[PHASES == 0][0]
        lines.append(f"| {coupling:g} | {PHASES[best]} deg | {speed[best]:.2f} | {straight:.2f} |")
    return "\n".join(lines) + "\n"


def cells():
    """The map as rows: mu tan(angle), tan(climb) / mu, throw number, restitution, velocity."""
    found = [
        Numbers(coupling, steepness, throw, rebound)
        for rebound in REBOUNDS
        for steepness in STEEPNESSES
        for throw in MAP_THROWS
        for coupling in COUPLINGS
    ]
    speed = velocities([with_numbers(one, FRICTION) for one in found])
    return np.column_stack([np.array(found)[:, :4], speed])


def csv(rows):
    """The map as CSV."""
    head = "mu_tan_angle,tan_climb_over_mu,throw_number,restitution,velocity\n"
    return head + "".join(",".join(f"{value:.4g}" for value in row) + "\n" for row in rows + 0.0)


def picture(rows):
    """The map as a figure, a panel for each restitution and climb."""
    from matplotlib.colors import TwoSlopeNorm

    from feederscrew.output import style

    figure = style.figure(8.0, 6.6)
    grid = figure.subplots(len(REBOUNDS), len(STEEPNESSES), sharex=True, sharey=True)
    panels = rows[:, 4].reshape(len(REBOUNDS), len(STEEPNESSES), len(MAP_THROWS), len(COUPLINGS))
    for i, rebound in enumerate(REBOUNDS):
        for j, steepness in enumerate(STEEPNESSES):
            axes = grid[i][j]
            title = f"restitution {rebound:g}, tan(climb)/friction {steepness:g}"
            style.tidy(axes, title=title, grid="none")
            mesh = axes.pcolormesh(
                COUPLINGS, MAP_THROWS, panels[i, j], cmap="PuOr_r", norm=TwoSlopeNorm(0, -1, 1)
            )
            lines = axes.contour(COUPLINGS, MAP_THROWS, panels[i, j], [0.0], colors=style.INK, linewidths=0.8)
            axes.clabel(lines, fmt="zero", fontsize=7)
            axes.set_xscale("log")
            axes.set_xticks(MARKS, [f"{mark:g}" for mark in MARKS])
            axes.set_xticks([], minor=True)
    for axes in grid[-1]:
        axes.set_xlabel("friction times tan(vibration angle)")
    for axes in grid[:, 0]:
        axes.set_ylabel("throw number")
    bar = figure.colorbar(mesh, ax=grid)
    bar.set_label("velocity over the plate's greatest speed along the track", fontsize=8, color=style.INK)
    bar.ax.tick_params(labelsize=8, labelcolor=style.INK)
    return style.png(figure)


def filled(text, name, table):
    """A page with one table as it is now."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, _, rest = text.partition(begin)
    return before + begin + table + end + rest.partition(end)[2]


def main():
    """Write or check; the exit status."""
    check = generated.is_checking(__doc__)
    pages = {DOCS / "conveying.md": ("phases", phases()), METHOD: ("throw numbers", throws())}
    texts = {page: filled(page.read_text(), *table) for page, table in pages.items()}
    table, rows = DOCS / "conveying_map.csv", cells()
    if check:
        shown = np.loadtxt(table, delimiter=",", skiprows=1)
        fresh = all(text == page.read_text() for page, text in texts.items())
        return 0 if fresh and np.allclose(shown, rows, rtol=1e-3, atol=1e-3, equal_nan=True) else 1
    for page, text in texts.items():
        page.write_text(text)
    table.write_text(csv(rows))
    (DOCS / "conveying_map.png").write_bytes(picture(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
