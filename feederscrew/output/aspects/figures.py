"""The pictures of ``feeder aspects``: its chart of probabilities and its sheet of views."""

from feederscrew.output.aspects import bars, picture, tables


def probabilities(study):
    """Draw the probability of each stable aspect: the recommended answer first, then every rule.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    Figure
    """
    part = study.part
    title = f"{part.name} (open surface)" if part.open_surface else part.name
    names, profiles = tables.profiles(study)
    answer = tables.answer(study)
    if answer is None:
        return bars.probabilities(names, profiles, title=title)
    return bars.answered(names, answer, profiles, title=title)


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
    return picture.aspects(study.part, study.aspects, rows, study.recommended)
