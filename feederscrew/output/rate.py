"""Files of ``feeder rate``."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.output import columns, tables
from feederscrew.output import offers as offer
from feederscrew.rates.tipping import remark
from feederscrew.rates.well_oriented import entering
from feederscrew.units import DEG, MM, MM_S, PER_MINUTE

SCARCE = 0.25  # share of the parts at the entry that stay on the track, below which it is said


def document(study) -> dict[Any, Any]:
    """Return a RateStudy as the JSON document: the part, the rate and every factor of its chain."""
    chain, rule = study.rate, study.rule
    coming, row = chain.orientations, chain.row
    return {
        **columns.part(
            study.part, (*study.aspects.warnings, *study.of_size, *stopping(study), *spaced(study))
        ),
        **_range("parts_per_minute", chain.parts, PER_MINUTE),
        "aspect": coming.aspects[row],
        "heading_deg": coming.headings[row] / DEG,
        **_range("offered_per_minute", chain.offered, PER_MINUTE),
        "efficiency": chain.efficiency,
        "purity": chain.purity,
        **_range("velocity_mm_s", chain.velocity, MM_S),
        "length_mm": coming.lengths[row] / MM,
        "gap_mm": chain.gap / MM,
        "pitch_mm": chain.pitch / MM,
        "rule": rule,
        "answer": study.answer,
        **_range("p_orientation", chain.probability, 1.0),
        "p_aspect": chain.probability.value / coming.heading_shares[row],
        "p_heading": coming.heading_shares[row],
        "passes_devices": chain.through,
        "fill": chain.fill,
        "well_oriented_of_leaving": chain.purity,
        "jams_per_hour": 3600.0 * chain.jams,
        "clearing_s": chain.clearing,
        "quasi_static": [device.kind for device in study.devices if device.turns],
        "rolls_back": [orientation.name for orientation in coming.lying if orientation.may_roll_back],
        "orientations": orientations(coming, rule),
    }


def orientations(coming, rule):
    """Return what each station does with each orientation, as a frame: the matrix of the chain.

    Parameters
    ----------
    coming : Orientations
    rule : str
    """
    stations = dict(zip(coming.names, coming.passes.T))
    return tables.frame(
        {
            "aspect": coming.aspects,
            "heading_deg": coming.headings / DEG,
            "length_mm": coming.lengths / MM,
            "width_mm": coming.widths / MM,
            f"p_{rule}": coming.rules[rule],
            "margin_mm": coming.margin / MM,
            "fate": coming.fates,
            "leaves_as": [_becomes(coming, row) for row in range(len(coming.aspects))],
            **stations,
            "passes": coming.through,
        }
    )


def _becomes(coming, row):
    """Name of the state in which most of an orientation leaves; None where it is returned."""
    return coming.states[int(coming.leaving[row].argmax())].name if coming.leaving[row].any() else None


def summary(document):
    """Return the document as a frame for people: the chain from velocity to rate."""
    d = document
    rows = [
        ("correctly oriented parts per minute", _with_range(d, "parts_per_minute")),
        *_both(d),
        ("aspect and heading", f"{d['aspect']} at {d['heading_deg']:.4g} deg"),
        ("velocity [mm/s]", _with_range(d, "velocity_mm_s")),
        ("parts offered per minute", _with_range(d, "offered_per_minute")),
        ("efficiency, correctly oriented of what is offered [%]", f"{100.0 * d['efficiency']:.4g}"),
        ("purity, correctly oriented of what leaves [%]", _number(100.0 * d["purity"])),
        ("mean pitch [mm]", f"{d['pitch_mm']:.4g} (wanted part {d['length_mm']:.4g}, gap {d['gap_mm']:.4g})"),
        ("probability of the orientation [%]", _with_range(d, "p_orientation", 100.0)),
        ("whose probabilities", d["answer"]),
        ("share that passes the devices [%]", f"{100.0 * d['passes_devices']:.4g}"),
        ("fill of the track [%]", f"{100.0 * d['fill']:.4g}"),
    ]
    rows += [("jams an hour", f"{d['jams_per_hour']:.4g}")] if d["jams_per_hour"] > 0.0 else []
    rows += (
        [("time a part swept off blocks the track [s]", f"{d['clearing_s']:.3g}")] if d["clearing_s"] else []
    )
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def _both(document) -> Iterator[Any]:
    """Lines of the trial and of the rule, where the bowl file has a trial that holds."""
    tried = document.get("verified")
    if tried:
        yield "of these as its trial showed", _with_range(tried, "parts_per_minute")
        yield "of these as the rule says", f"{document['parts_per_minute_static']:.4g}"


def remarks(study):
    """Return what a reader of a RateStudy must not overlook, a sentence each."""
    chain = study.rate
    if chain.velocity.value <= 0.0:
        return ["the part does not travel up the track: see feeder convey"]
    turned = [
        *stopping(study),
        *spaced(study),
        *_tipping(chain),
        *_rolling(chain),
        *_scarce(study),
        *_turned(study.devices),
    ]
    if chain.orientations.lying[chain.row].turns_over:
        return turned
    if chain.through == 0.0 and chain.efficiency > 0.0:
        return [
            *turned,
            "what lands in the wanted orientation is turned or returned; what leaves in it was turned",
        ]
    if chain.through == 0.0:
        stations = zip(("the track", *map(_named, study.devices)), chain.orientations.passes[chain.row])
        names = [name for name, share in stations if share == 0.0]
        verb = "reject" if len(names) > 1 else "rejects"
        return [f"{' and '.join(names)} {verb} the orientation you want; rate is 0"]
    return turned


def stopping(study):
    """Return what comes to stand before which device, a sentence each."""
    chain, lines = study.rate, []
    coming = chain.orientations
    for place, name in enumerate(("the track", *(f"the {device.name}" for device in study.devices))):
        stands = [device.name for device, share in zip(coming.lying, coming.stops[:, place]) if share > 0.0]
        if stands and chain.jams > 0.0:
            verb = "stops" if len(stands) == 1 else "stop"
            lines.append(
                f"{units.listed(stands)} {verb} before {name} and nothing behind gets through: a jam; "
                "efficiency and rate hold between jams only"
            )
    return lines


def spaced(study) -> list[Any]:
    """Return which devices need more room between parts than they come with, a sentence each."""
    free = study.rate.orientations.gap
    if study.rate.gap > free or not free > 0.0:
        return []
    kinds = units.listed(
        [device.name for device in study.devices if device.gap(study.rate.orientations.lying[0], 0.0) > 0.0]
    )
    return [
        f"{kinds} looks at one part at a time: the rate is that of parts that come {free / MM:.3g} mm apart "
        "- a spacing section before it makes that less"
    ]


def _tipping(chain):
    """What tips on the track at this drive, and what becomes of it."""
    coming = chain.orientations
    if coming.tipping is None:
        return []
    rocks = coming.tipping.tips & ~coming.tipping.over
    lost = "; rate is 0" if coming.lying[chain.row].turns_over else ""
    lines = [f"{line}{lost}" for line in remark(coming.lying)]
    if rocks[chain.row]:
        tilt, lean = (np.degrees(angle[chain.row]) for angle in (coming.tipping.tilt, coming.tipping.balance))
        lines.append(
            f"{coming.lying[chain.row].name} rocks on the track: a stroke tilts it by {tilt:.2g} deg at "
            f"most, and from {lean:.3g} deg it would tip over"
        )
    return lines


def _rolling(chain):
    """What lies on its round side and may roll back."""
    lying = chain.orientations.lying
    along = [orientation.name for orientation in lying if orientation.along_a_bank]
    why = (
        "no bank brings to the wall what rolls along the track: no verdict on it is sure, and the purity "
        "counts it as leaving where the track carries it; see feeder trial"
    )
    loose = [f"{units.listed(along)}: {why}"] if along else []
    rolls_back = [orientation.name for orientation in lying if orientation.may_roll_back]
    if not rolls_back:
        return loose
    lies, rolls, counts = ("lies", "rolls", "counts") if len(rolls_back) == 1 else ("lie", "roll", "count")
    where = f"{lies} on the round side, not along the track, and {rolls} back down the climb"
    sentence = f"{units.listed(rolls_back)} {where}"
    lost = "; rate is 0" if lying[chain.row].may_roll_back else ""
    return [
        f"{sentence}: {counts} as returned, but as carried in the highest rate{lost}; see feeder trial",
        *loose,
    ]


def _scarce(study) -> list[Any]:
    """How many parts have to come to the entry where few of them stay on the track."""
    share, offered = entering(study.rate.orientations, study.rule)[1], study.rate.offered.value
    if not 0.0 < share < SCARCE or not offered > 0.0:
        return []
    come = offered / share / PER_MINUTE
    none = study.rate.parts.low == 0.0 < study.rate.velocity.low
    return [
        f"{100.0 * share:.2g} % of the parts at the entry stay on the track: this rate "
        f"needs {come:,.0f} parts a minute there{', and is 0 if none stays' if none else ''}"
    ]


def _turned(devices) -> list[Any]:
    """What is not certain of the devices."""
    names = [device.name for device in devices if device.turns]
    return [f"{', '.join(names)}: quasi-static, until a trial confirms it"] if names else []


def _named(device):
    return f"{device.name} ({device.text})" if np.isfinite(device.limit) else device.name


def _range(name, ends, unit) -> dict[Any, Any]:
    return {name: ends.value / unit, f"{name}_low": ends.low / unit, f"{name}_high": ends.high / unit}


def _with_range(document, name, scale=1.0) -> str:
    value, low, high = (scale * document[key] for key in (name, f"{name}_low", f"{name}_high"))
    return f"{value:.4g} ({low:.4g} to {high:.4g})"


def _number(value) -> str:
    return "none" if np.isnan(value) else f"{value:.4g}"


def offers(study) -> list[Any]:
    """Offer the files of a RateStudy, as a list of Offer."""
    return [
        offer.document("rate.json", document, study),
        offer.table("orientations.csv", orientations, study.rate.orientations, study.rule),
    ]
