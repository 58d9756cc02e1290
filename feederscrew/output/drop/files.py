"""What ``feeder drop`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.drop import tables, trace_tables


def offers(study):
    """Offer the counts of a drop test and, where drops were followed, their motion.

    Parameters
    ----------
    study : DropStudy

    Returns
    -------
    list of Offer
    """
    offered = [
        offer.table("drop.csv", tables.counts, study),
        offer.document("drop.json", tables.document, study),
        offer.picture("drop.png", "How often the part was found on each aspect", _counts, study),
    ]
    if study.result.traces:
        offered += [
            offer.table("drop_traces.csv", trace_tables.traces, study),
            offer.picture("drop_trace.png", "One drop in stills, and its energy below", _strip, study),
        ]
    return offered


def _counts(study):
    from feederscrew.output.drop import figures

    return figures.counts(tables.title(study), study.aspects, study.result.tally, study.rules)


def _strip(study):
    from feederscrew.output.drop import trace_strip

    trace = study.telling
    title = f"{study.part.name}: drop {trace.number}, {study.result.launch['name']}"
    return trace_strip.strip(study.part, study.aspects, trace, title)
