"""What ``feeder track`` leaves in its folder."""

import numpy as np

from feederscrew.output import offers as offer
from feederscrew.output.track import map_tables, tables

SHOWN = "acceleration_x_m_s2"


def offers(study, settings, grid):
    """Offer the files of a TrackStudy.

    Parameters
    ----------
    study : TrackStudy
    settings : dict of str to str
        The bowl's values in effect.
    grid : Grid
        Of ``study.over``.

    Returns
    -------
    list of Offer
    """
    differences = [
        offer.table("track_difference.csv", tables.differences, study),
        offer.table("track_omitted_terms.csv", tables.omitted_terms, study),
    ]
    return [
        offer.document("track.json", tables.document, study, settings),
        offer.table("track_cycle.csv", tables.over_cycle, study.cycle, study.course),
        offer.table("track_map.csv", map_tables.cells, grid),
        *(differences if study.printed is not None else []),
        offer.picture(
            "track_part.png",
            "The part on the track from above and from behind, with the forces on it",
            _part, study,
        ),
        offer.picture("track_cycle.png", "Reactions over one cycle", _cycle, study),
        offer.picture("track_map.png", f"Acceleration along the track over {_axes(grid)}", _map, study, grid),
    ]  # fmt: skip


def at_one_point(study):
    """Offer what needs no map, as a list of Offer."""
    return [
        offer.table("track_cycle.csv", tables.over_cycle, study.cycle, study.course),
        offer.picture("track_part.png", "The part on the track, with the forces on it", _part, study),
        offer.picture("track_cycle.png", "Reactions over one cycle", _cycle, study),
    ]


def _part(study):
    from feederscrew.output.track import figures

    return figures.part(study, _title(study))


def _cycle(study):
    from feederscrew.output.track import figures

    return figures.cycle(study.cycle, study.course, _title(study))


def _map(study, grid):
    from feederscrew.output.floor.map_figures import regime_map

    return regime_map(
        grid, SHOWN, title=_title(study), labels=map_tables.labels(grid),
        value="acceleration V'_X at the upper reversal [m/s²]",
        own=map_tables.own_point(grid, study.bowl), note=map_tables.remarks(grid),
    )  # fmt: skip


def _axes(grid):
    return " and ".join(label.partition(" [")[0] for label in map_tables.labels(grid))


def _title(study):
    heading = f"{np.degrees(study.seat.heading):.4g}°"
    return f"{study.part.name}, aspect {study.posture.name}, heading {heading}"
