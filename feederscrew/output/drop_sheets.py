"""Drop tests as tables, documents and files."""

from feederscrew.output import tables
from feederscrew.output.columns import MM


def counts(aspects, tally):
    """One row an aspect: how many drops rest on it.

    Parameters
    ----------
    aspects : Aspects
    tally : Tally

    Returns
    -------
    DataFrame
        The columns of ``drop.csv``.
    """
    return tables.frame(
        {
            "aspect": aspects.names,
            "height_mm": aspects.heights / MM,
            "count": tally.counts,
            "p_drop": tally.p,
            "p_drop_low": tally.low,
            "p_drop_high": tally.high,
            "p_gentle": tally.gentle,
            "p_violent": tally.violent,
        }
    )


def document(part, aspects, result):
    """The drop test as one JSON document.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    result : feederscrew.resting.drop.report.Result

    Returns
    -------
    dict
    """
    return {
        "part": part.name,
        "drops": len(result.drops.faces),
        "seed": result.seed,
        "launch": result.launch,
        "partial": result.drops.partial,
        "unsettled": result.tally.unsettled,
        "aspects": counts(aspects, result.tally),
    }


def remarks(document):
    """What a user must know of a drop test, a line each."""
    told = []
    if document["partial"]:
        told.append(f"partial: stopped after {document['drops']} drops")
    if document["unsettled"]:
        told.append(f"{document['unsettled']} of {document['drops']} drops came to rest on no aspect")
    return told


def write(folder, part, aspects, result, document, *, pictures=True):
    """The files of ``feeder drop``.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    aspects : Aspects
    result : feederscrew.resting.drop.report.Result
    document : dict
        Of the JSON file; its ``aspects`` is the table.
    pictures : bool
        False for the tables only.
    """
    folder.write("drop.csv", tables.text(document["aspects"], "csv"))
    folder.write("drop.json", tables.json_text(document))
    if pictures:
        from feederscrew.output import drop_plots, plots

        title = f"{part.name}: {document['drops']} drops, {document['launch']['name']}"
        rules = {"csa": aspects.probabilities["csa"]}
        folder.write("drop.png", plots.png(drop_plots.counts(title, aspects, result.tally, rules)))
