"""The machine and the bowl for a part: what ``feeder bowl`` writes."""

from feederscrew.output.offers import document, picture, table


def offers(study):
    """Return the files of a machine.

    Parameters
    ----------
    study : MachineSheet

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output import solidbowl
    from feederscrew.output.machine import figures, tables

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    solid = () if study.solid is None else solidbowl.offers(study)
    return (
        *solid,
        document("bowl.json", tables.document, study),
        table("bowl.csv", tables.summary, study),
        table("bowl_angles.csv", tables.angles, study),
        table("bowl_leaves.csv", tables.leaf_sets, study.sets),
        table("bowl_leaf_changes.csv", tables.leaf_sets, study.changes),
        table("bowl_emptying.csv", tables.emptying, study),
        picture("bowl.png", alt, figures.bowl, study),
    )
