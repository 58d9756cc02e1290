"""The machine and the bowl for a part: what ``feeder bowl`` writes."""

from feederscrew.output import marking, proof
from feederscrew.output.offers import document, picture, table


def offers(study, tried=None, mark=None):
    """Return the files of a machine.

    Parameters
    ----------
    study : MachineSheet
    tried : Verified, optional
        What a trial of exactly this bowl at this stroke has shown: it leads, and what falls short is marked.
    mark : str, optional
        Across every drawing; that of the trial without it.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output import solidbowl
    from feederscrew.output.machine import figures, tables

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    solid = () if study.solid is None else solidbowl.offers(study, tried, mark)
    drawn = picture("bowl.png", alt, figures.bowl, study, tried)
    return (
        *solid,
        document("bowl.json", _document, study, tried),
        table("bowl.csv", tables.summary, study, tried),
        table("bowl_angles.csv", tables.angles, study),
        table("bowl_leaves.csv", tables.leaf_sets, study.sets),
        table("bowl_leaf_changes.csv", tables.leaf_sets, study.changes),
        table("bowl_emptying.csv", tables.emptying, study),
        *marking.pictures([drawn], marking.of_trial(tried, mark)),
    )


def _document(study, tried):
    from feederscrew.output.machine import tables

    return tables.document(study) | ({} if tried is None else {"verified": proof.block(tried)})
