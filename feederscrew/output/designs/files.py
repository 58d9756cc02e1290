"""What ``feeder design`` leaves in its folder."""

from feederscrew.designing import record
from feederscrew.output import machine, marking, solidbowl, tooling
from feederscrew.output import offers as offer
from feederscrew.output.designs import design_file, tables


def offers(study, settings, built=None):
    """Offer the files of a DesignStudy, as a list of Offer.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        As the user gave them.
    built : designing.beside.Built, optional
        The machine below the bowl, and the bowl as a solid.

    Returns
    -------
    list of Offer
        Document, page and acceptance sheet; of a design with a bowl the bowl file, and everything of the
        tooling, of the machine and of the bowl as a solid. Of one that is not proved, or that delivers
        nothing, what was tried only: nothing to build from. Drawings of what falls short bear a mark.
    """
    if study.status == record.NOT_PROVED:
        return list(_unproved(study, settings))
    sheet, drawn = (None, None) if built is None else (built.sheet, built.drawn)
    found = [
        offer.document("design.json", tables.document, study),
        offer.text("design.html", _page, study, built),
        offer.table("design_trials.csv", tables.attempts, study),
        offer.table("alternatives.csv", tables.alternatives, study),
        offer.picture("design_history.png", "Each short trial of the loop", _history, study),
    ]
    for one in study.risks:
        if one.pair is not None:
            found.append(offer.picture(f"risk_{one.kind}.png", one.text, _pair, study.part, one))
    if study.bowl is None:
        return found
    found.append(offer.text("design.yaml", design_file.bowl_file, study, settings, sheet))
    if not study.delivers:
        return found
    tried = design_file.trial(study)
    found.append(offer.table("acceptance.csv", tables.acceptance, study))
    if sheet is not None:
        found += machine.offers(sheet, tried)
    if drawn is not None:
        found += solidbowl.offers(drawn, tried)
        found.append(offer.document("bowl_solid.json", solidbowl.document, drawn.solid))
    if study.tooling is not None:
        own = tooling.offers(study.tooling, settings, mark=marking.of_trial(tried))
        found += [one for one in own if one.name != "tooling.yaml"]  # design.yaml has the devices
    return found


def _unproved(study, settings):
    """What is handed over of a design that was stopped."""
    yield offer.document("design.json", tables.document, study)
    yield offer.table("design_trials.csv", tables.attempts, study)
    if study.bowl is not None:
        yield offer.text("design.yaml", design_file.bowl_file, study, settings)


def _page(study, built):
    from feederscrew.output.designs import design_page

    return design_page.page(study, built)


def _pair(part, risk):
    from feederscrew.output.designs import risk_pictures

    return risk_pictures.drawn(part, risk)


def _history(study):
    from feederscrew.output.designs import figures

    return figures.history(study)
