"""What ``feeder convey`` leaves in its folder: at one point, along a curve, over a map."""

from feederscrew.output import offers as offer
from feederscrew.output.convey import phase_tables, tables


def offers(study, settings):
    """Offer the files of a ConveyStudy.

    Parameters
    ----------
    study : ConveyStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    list of Offer
    """
    return [
        offer.document("convey.json", lambda: tables.document(study) | {"bowl": settings}),
        offer.picture("convey.png", "Plate and part over one steady cycle", _cycle, study),
    ]


def curve_offers(study):
    """Offer the files of a ConveyCurve, as a list of Offer."""
    name, alt = f"convey_{study.kind}", f"Velocity over {study.over}"
    return [
        offer.table(f"{name}.csv", tables.points, study),
        offer.picture(f"{name}.png", alt, _curve, study, alt),
    ]


def phase_offers(study, settings):
    """Offer the files of a ConveyPhase, as a list of Offer; ``settings`` as for ``offers``."""
    return [
        offer.document(
            "convey_phase.json", lambda: {"best_phase": phase_tables.document(study.best), "bowl": settings}
        ),
        *curve_offers(study.curve),
    ]


def map_offers(study):
    """Offer the files of a ConveyMap, as a list of Offer."""
    names = " and ".join(one.key.name.rpartition(".")[2].replace("_", " ") for one in study.ranges)
    return [
        offer.table("convey_map.csv", tables.cells, study),
        offer.picture("convey_map.png", f"Velocity and regimes over {names}", _map, study),
    ]


def _cycle(study):
    from feederscrew.output.convey import figures

    return figures.cycle(study.trace(), study.bowl.drive.amplitude, study.answer)


def _curve(study, title):
    from feederscrew.output.convey import figures

    return figures.curve(tables.points(study), title)


def _map(study):
    from feederscrew.output.convey import figures

    line = None if study.line is None else figures.on_axes(study.ranges, study.line)
    return figures.velocity_map(study.grid, line)
