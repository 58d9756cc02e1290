"""Drop tests as tables, documents and files."""

from feederscrew.output import tables
from feederscrew.output.columns import MM
from feederscrew.output.drop import trace_files as drop_trace_sheets


def counts(aspects, tally, partial=False):
    """One row an aspect: how many drops rest on it.

    Parameters
    ----------
    aspects : Aspects
    tally : Tally
    partial : bool
        Stopped by the user: labelled in every row.

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
            **({"partial": [True] * len(aspects.names)} if partial else {}),
        }
    )


def document(part, aspects, result):
    """The drop test as one JSON document.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    result : feederscrew.dropping.runs.Result

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
        "until": result.aim,
        "widest": result.tally.widest,
        "traces": drop_trace_sheets.listed(aspects, result.traces),
        "aspects": counts(aspects, result.tally, result.drops.partial),
    }


def remarks(document):
    """What a user must know of a drop test, a line each."""
    told = []
    if document["partial"]:
        told.append(f"partial: stopped after {document['drops']} drops")
    elif document["until"] is not None and document["widest"] > document["until"]:
        told.append(
            f"after {document['drops']} drops the widest interval is {100.0 * document['widest']:.3g} % to "
            f"either side, not {100.0 * document['until']:.3g} % - give more --drops, or a wider --until"
        )
    if document["unsettled"]:
        told.append(f"{document['unsettled']} of {document['drops']} drops came to rest on no aspect")
    return told


def _title(part, document):
    """What the picture is of, and what is the matter with it."""
    title = f"{part.name}: {document['drops']} drops, {document['launch']['name']}"
    unsettled = f", {document['unsettled']} unsettled" if document["unsettled"] else ""
    return title + unsettled + ", partial" * document["partial"]


def write(folder, part, aspects, result, document, *, pictures=True):
    """The files of ``feeder drop``.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    aspects : Aspects
    result : feederscrew.dropping.runs.Result
    document : dict
        Of the JSON file; its ``aspects`` is the table.
    pictures : bool
        False for the tables only.
    """
    folder.write("drop.csv", tables.text(document["aspects"], "csv"))
    folder.write("drop.json", tables.json_text(document))
    if result.traces:
        drop_trace_sheets.write(folder, part, aspects, result, pictures=pictures)
    if pictures:
        from feederscrew.output import style
        from feederscrew.output.drop import figures as drop_plots

        rules = {rule: aspects.probabilities[rule] for rule in ("csa", "surface")}
        chart = drop_plots.counts(_title(part, document), aspects, result.tally, rules)
        folder.write("drop.png", style.png(chart))
