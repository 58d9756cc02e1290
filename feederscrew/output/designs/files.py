"""What ``feeder design`` leaves in its folder."""

from feederscrew.output import machine
from feederscrew.output import offers as offer
from feederscrew.output.designs import design_file, tables
from feederscrew.output.tooling import files as tooling_files


def offers(study, settings, sheet=None):
    """Offer the files of a DesignStudy, as a list of Offer.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        As the user gave them.
    sheet : MachineSheet, optional
        Of the machine below the bowl.

    Returns
    -------
    list of Offer
        Document, page and acceptance sheet; of a design with a bowl the bowl file, and everything of the
        tooling and of the machine.
    """
    found = [
        offer.document("design.json", tables.document, study),
        offer.text("design.html", _page, study),
        offer.table("acceptance.csv", tables.acceptance, study),
        offer.table("design_trials.csv", tables.attempts, study),
        offer.picture("design_history.png", "Each short trial of the loop", _history, study),
    ]
    if study.bowl is None:
        return found
    found.append(offer.text("design.yaml", design_file.bowl_file, study, settings, sheet))
    if sheet is not None:
        found += machine.offers(sheet)
    if study.tooling is not None:
        own = tooling_files.offers(study.tooling, settings)
        found += [one for one in own if one.name != "tooling.yaml"]  # design.yaml has the devices
    return found


def _page(study):
    from feederscrew.output.designs import design_page

    return design_page.page(study)


def _history(study):
    from feederscrew.output.designs import figures

    return figures.history(study)
