"""Feeding tests beside the static rules, as tables and documents."""

from pathlib import Path

from feederscrew.output import offers as offer
from feederscrew.output import tables

NAME = "devices.csv"


def offers(study):
    """Offer the table of a FeedingStudy, as a list of Offer."""
    return [offer.table(NAME, comparisons, study)]


def comparisons(study):
    """Return what passed each device, measured and predicted, a row a device.

    Parameters
    ----------
    study : FeedingStudy

    Returns
    -------
    Frame
        The columns of ``devices.csv``: shares of the parts that came to the device.
    """
    return frame([study])


def shown(study, _):
    """Return what is printed in any format: ``comparisons``."""
    return comparisons(study)


def frame(studies):
    """Return the same of several feeding tests; the answer of a rule that a test does not have is empty."""
    rows = [row for study in studies for row in _rows(study)]
    names = dict.fromkeys(name for row in rows for name in row)
    return tables.frame({name: [row.get(name) for row in rows] for name in names})


def printed(studies):
    """Return the table for people: without the rules, each share with its interval, files without folders."""
    found = frame(studies)
    columns = found.only(("set", "device", "passed", "rejected"))
    columns["set"] = [Path(name).name for name in found["set"]]
    for name in ("measured", "predicted"):
        ends = zip(found[name], found[f"{name}_low"], found[f"{name}_high"])
        columns[name] = ["{:.3f} ({:.3f} to {:.3f})".format(*three) for three in ends]
    return tables.frame(columns | {"agrees": found["agrees"]})


def hidden(study):
    """Return the columns that a table for people leaves out: the file, and what the rules predict."""
    return ("set", *_rules([study]))


def document(study):
    """Return one feeding test as a JSON document.

    Parameters
    ----------
    study : FeedingStudy

    Returns
    -------
    dict
    """
    head = study.measured.head
    return {
        "part": study.part.name,
        "file": study.measured.source,
        **{key: value for key, value in vars(head).items() if value and key != "part"},
        "answer": study.answer,
        "devices": comparisons(study),
    }


def _rules(studies):
    return tuple(dict.fromkeys(f"p_{rule}" for one in studies for rule in _own(one)))


def _own(study):
    """The rules whose own prediction stands beside the recommended answer's."""
    return [rule for rule in study.answers if rule != "recommended"]


def _rows(study):
    counts, ends = study.measured, study.ends
    for k, station in enumerate(study.stations):
        yield {
            "set": counts.source,
            "device": station,
            "passed": int(counts.passed[k]),
            "rejected": int(counts.rejected[k]),
            "measured": float(counts.shares[k]),
            "measured_low": ends[k, 0],
            "measured_high": ends[k, 1],
            "predicted": float(study.answers["recommended"][k]),
            "predicted_low": float(study.low[k]),
            "predicted_high": float(study.high[k]),
            "agrees": bool(study.agrees[k]),
            **{f"p_{rule}": float(study.answers[rule][k]) for rule in _own(study)},
        }
