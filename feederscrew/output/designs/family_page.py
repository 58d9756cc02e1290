"""Several parts in one bowl on one page: what each delivers, and the list of what is changed."""

from feederscrew.designing import record
from feederscrew.output import offers as offer
from feederscrew.output.designs import family, tables
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, CsvSheet, Heading, Notes, Page, Table, Text, Tile
from feederscrew.output.tables import frame, text

HOW = (
    "set: at the controller of the drive.",
    "taught: the sensor is shown the part that comes next.",
    "swapped: by hand, with the bowl at rest.",
)


def page(study):
    """Return the page of a FamilyStudy as HTML that needs no other file."""
    names = " and ".join(one.part.name for one in study.members)
    return html(
        Page(names, f"one bowl for several parts: {study.status}", tuple(_chapters(study)), kind="design")
    )


def _chapters(study):
    answer = [Text(_said(study)), Table(frame(parts(study)))]
    answer += [Text("The machine that each part asks for:"), Notes(tuple(_machines(study)))]
    warned = tuple(
        dict.fromkeys(f"{one.part.name}: {said}" for one in study.members for said in one.warnings)
    )
    answer += [Notes(warned, loud=True)] if warned else []
    answer += [Notes(tuple(said), loud=True) for said in (_risks(study),) if said]
    yield Chapter(tuple(answer), tuple(_tiles(study)), anchor="answer", title="The answer")
    changed = family.changeover(study)
    if changed["what"]:
        sheet = frame(changed)
        blocks: tuple = (
            Table(sheet),
            CsvSheet("changeover.csv", text(sheet, "csv"), shown=False),
            Heading("How"),
            Notes(HOW),
        )
    else:
        blocks = (Text("Nothing is changed from one part to the next."),)
    yield Chapter(blocks, anchor="changeover", title="Changeover")


def _said(study):
    if study.partial:
        return "It was stopped before all parts were designed."
    if study.shared and study.status == record.HOLDS:
        return (
            "One track and one chain of devices suit all parts: what is listed below is only set or taught."
        )
    if study.shared:
        return "One track and one chain of devices were tried with all parts, and do not hold for each."
    return "The parts do not share one chain: the list below names what is swapped."


def _tiles(study):
    yield Tile("status", study.status, "the worst of all parts")
    yield Tile("one bowl for all", "yes" if study.shared else "no", "same track and same devices")
    rows = family.changes(study)
    by_hand = sum(how == family.SWAPPED for _, how, _ in rows)
    yield Tile("changed", f"{len(rows)}", f"{by_hand} of them by hand")


def _machines(study):
    for one in study.members:
        told = tables.machine(one)
        text = "no bowl" if told is None else tables.machine_text(told)
        yield f"{one.part.name}: {text}"


def _risks(study):
    return [f"{one.part.name}: {risk.text}" for one in study.members for risk in one.risks]


def parts(study):
    """Return columns of what each part delivers, and where its own page is."""
    rows = []
    for one in study.members:
        d = tables.document(one)
        rows.append(
            {
                "part": one.part.name,
                "status": d["status"],
                "leaves as": d["wanted"] or family.NOTHING,
                "asked_per_minute": d["target_per_minute"],
                "delivered_per_minute": d["delivered_per_minute"],
                "at_least_per_minute": d["delivered_low"],
                "purity": d["purity"],
                "jams": d["jams"],
                "devices": ", ".join(device["device"] for device in d["chain"]) or "none",
                "page": f"{one.part.name}/design.html",
            }
        )
    return {name: [row[name] for row in rows] for name in rows[0]}


def offers(study):
    """Offer the files of a FamilyStudy itself, as a list of Offer; each part has its own folder."""
    if study.partial:  # nothing to build from
        return [offer.document("family.json", family.document, study)]
    return [
        offer.document("family.json", family.document, study),
        offer.table("changeover.csv", family.changeover, study),
        offer.text("family.html", page, study),
    ]
