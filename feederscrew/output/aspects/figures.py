"""The pictures of ``feeder aspects``: its chart of probabilities and its sheet of views."""

from feederscrew.output.aspects import bars, picture, tables


def probabilities(study):
    """Draw the probability of each stable aspect by every rule.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    Figure
    """
    part = study.part
    title = f"{part.name} (open surface)" if part.open_surface else part.name
    return bars.probabilities(*tables.profiles(study), title=title)


def sheet(study):
    """Draw the part as it rests on each of its first aspects.

    Parameters
    ----------
    study : AspectsStudy
        Of a part with a mesh.

    Returns
    -------
    Figure
    """
    rows = range(min(len(study.aspects.names), tables.MOST))
    return picture.aspects(study.part, study.aspects, rows)
