"""What ``feeder inertia`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.inertia import tables


def offers(study, format="csv"):
    """Offer the mass properties of a part.

    Parameters
    ----------
    study : InertiaStudy
    format : str
        'json' for a document, else a table.

    Returns
    -------
    list of Offer
    """
    if format == "json":
        return [offer.document("inertia.json", tables.document, study)]
    return [offer.table("inertia.csv", tables.rows, study)]
