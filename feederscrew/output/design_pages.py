"""The page of ``feeder design``, of one part and of a family of parts."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import zip_longest
from typing import Any

from feederscrew import units
from feederscrew.designing import record
from feederscrew.output import designs, machine, marking, solidbowl, solidbowl_views, tooling
from feederscrew.output import offers as offer
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import (
    Chapter,
    CsvSheet,
    Heading,
    MarkedCell,
    Matrix,
    Notes,
    Page,
    Picture,
    Table,
    Text,
    Tile,
    Views,
)
from feederscrew.output.style import png
from feederscrew.output.tables import frame, text
from feederscrew.output.trial import playback

MEASURE = (
    "Stroke: the sticker on the rim shows it peak to peak; below the computed one, raise the controller, and "
    "look for a part that touches the frame.",
    "Acceleration: an accelerometer on the bowl, along the vibration; where the stroke is right and the "
    "acceleration is not, the frequency is another one.",
    "Natural frequency: tap the bowl with the drive off and read the decay; it shall lie 3 to 8 % above the "
    "drive: add a leaf or take one off.",
    "Friction: lay a part on a strip of the track's sheet and tilt it until it slides; oil brings it down, "
    "and the rate with it.",
)


SHOP = (  # what a shop reads of the machine, rows of its summary
    "vibration angle [deg]", "leaves", "springs", "natural frequency [Hz]", "above the drive [%], gain",
    "leaf stress [MPa]", "force of the magnet [N]",
)  # fmt: skip
FILES = {  # by ending: what they are
    "pdf": "sheets of the bowl, its springs, its tooling and the sheet development of its track",
    "dxf": "drawing with dimensions, to cut from",
    "svg": "the same drawing, to look at",
    "step": "solid with exact faces",
    "3mf": "solid to print, in mm",
    "stl": "solid as a mesh, in mm",
    "yaml": "bowl file for the other commands of feeder",
}


def page(study, built=None, papers=()):
    """Return the page of a design as HTML that needs no other file.

    Parameters
    ----------
    study : DesignStudy
    built : designing.beside.Built, optional
    papers : sequence of Offer
        The other files of the design: some are shown, and those to build from have a link.

    Returns
    -------
    str
    """
    chapters = tuple(_sections(study, built, offer.by_name(papers)))
    return html(Page(study.part.name, f"design of a bowl: {study.status}", chapters, kind="design"))


def _sections(study, built, papers) -> Iterator[Any]:
    d = designs.document(study)
    answer = tuple(_answer(study, d))
    yield Chapter(answer, _tiles(d), study.warnings, anchor="answer", title="The answer")
    if built is not None and study.delivers:
        yield from _to_build(study, built, papers)
    history = designs.short_attempts(study)
    picture = Picture(
        "design_history.png", png(designs.history_figure(study)), "Each short trial of the loop"
    )
    lead = Text(
        "Each line is one short trial: a chain on its bowl, every orientation that comes often enough. What "
        "the trial denies is changed in the next. design_trials.csv has the dimensions of each device."
    )
    tried = (lead, Table(history), picture) if study.attempts else (lead,)
    yield Chapter(tried, anchor="loop", title="The loop")
    if study.trials:
        yield Chapter(tuple(_played(study)), anchor="trial", title="The trial")
    if study.queues:
        yield Chapter(tuple(_proof(study, d)), anchor="proof", title="The proof")
    if not study.delivers:  # nothing to build from, nothing to accept
        return
    sheet = designs.acceptance(study)
    blocks = (
        Text("Computed values, with empty cells for what is measured at the machine."),
        Table(sheet),
        CsvSheet("acceptance.csv", text(sheet, "csv"), on_page=False),
        Heading("What to measure"),
        Notes(MEASURE),
    )
    yield Chapter(blocks, anchor="acceptance", title="Acceptance sheet")


def _to_build(study, built, papers) -> Iterator[Chapter]:
    """What a shop builds from: the bowl, its tooling, springs and drive, and the files of them."""
    mark = marking.of_trial(designs.trial_of(study))
    views = solidbowl_views.blocks(built.drawn and built.drawn.solid, study.part, built.why, mark)
    yield Chapter(tuple(views), anchor="bowl", title="The bowl")
    drawn = [
        Picture(name, content if isinstance(content := papers[name].make(), bytes) else content.encode(), alt)
        for name, alt in (
            ("tooling_3d.png", "The part over the cut: what leaves, and what falls by least"),
            ("tooling.png", "Each orientation at each device, and the section in which it leaves"),
            ("tooling.svg", "The tooling unrolled, with its dimensions, and as it is bent"),
        )
        if name in papers
    ]
    if drawn:
        lead = Text("The part over the cut, what each device does, and the drawing of the cuts.")
        yield Chapter((lead, *drawn), anchor="tooling", title="The tooling")
    if built.sheet is not None:
        summary = machine.summary(built.sheet)
        rows = [row for row in summary.rows() if row["quantity"] in SHOP]
        springs = Table(frame({name: [row[name] for row in rows] for name in summary}))
        bowl_pictures = [
            Picture(picture.name, picture.make(), picture.alt)
            for name, picture in papers.items()
            if name == "bowl.png"
        ]
        yield Chapter((springs, *bowl_pictures), anchor="springs", title="Springs and drive")
    listed = [(name, FILES.get(name.rpartition(".")[2])) for name in papers]
    cells = tuple((MarkedCell(name, link=name), MarkedCell(what)) for name, what in listed if what)
    if cells:
        lead = Text("These files lie beside this page.")
        yield Chapter(
            (lead, Matrix(("file", "what it is"), cells)), anchor="files", title="Files to build from"
        )


def _answer(study, d) -> Iterator[Any]:
    yield Text(_status(study))
    if d["machine"]:
        yield Text(f"The machine: {designs.machine_text(d['machine'])}.")
    yield Table(designs.two_columns(designs.outcome(d, study.devices)))
    if study.alternatives:
        yield Heading("Cheapest first: steel (1), steady air (2), a sensor with a valve (3)")
        yield Table(designs.alternatives(study))
    if d["bowl"]:
        yield Table(designs.two_columns(designs.dimensions(d)))
    if study.risks:
        yield Notes(tuple(risk.text for risk in study.risks), loud=True)
        yield from _pairs(study)


def _pairs(study) -> Iterator[Any]:
    """Pictures of what may go wrong between two parts, or a part and two walls."""
    for risk in study.risks:
        if risk.pair is not None:
            yield Picture(
                f"risk_{risk.kind}.png", png(designs.risk_picture(study.part, risk)), risk.text, printed=True
            )


def _status(study) -> str:
    """What the status says, in a sentence: what is missing, or what all was reached."""
    if study.status != record.HOLDS:
        return f"Status: {study.status}. {study.why}."
    least, draws = 60.0 * record.RATE_KEPT * study.request.target, 100.0 * record.DRAWS_HELD
    return (
        f"Status: {study.status}. The lower end of the rate is at least {least:.3g} a minute, the purity at "
        f"least {100.0 * record.PURE:.3g} %; nothing jams, and at least {draws:.3g} % of the draws sort."
    )


def _tiles(d) -> tuple[Any, ...]:
    return (
        Tile("status", d["status"], d["wanted"] or "no orientation"),
        Tile(
            "parts per minute",
            f"{d['delivered_per_minute']:.3g}",
            f"{d['delivered_low']:.3g} to {d['delivered_high']:.3g}, asked {d['target_per_minute']:.3g}",
        ),
        Tile(
            "purity", "-" if d["purity"] is None else f"{100.0 * d['purity']:.3g} %", "of what left the queue"
        ),
        Tile("jams", f"{d['jams']}", f"in {d['queue_seconds']:.3g} s of queue"),
    )


def _played(study) -> Iterator[Any]:
    yield Text("Parts of the short trial at the device that decides.")
    scene, captions = playback.scene(study.part, *study.trials)
    yield Views(
        scene,
        tuple((*caption, ()) for caption in captions),
        "trial-views",
        "Orientation",
        plays=True,
        printed=True,
    )


def _proof(study, d) -> Iterator[Any]:
    yield Text(
        "A queue of parts that push each other, at three fills, and draws of part, friction, drive and cuts, "
        "each tried with parts of its own."
    )
    if d["long_ride"]:
        yield Text(
            "Parts of each orientation that comes often first ride along the bare track to the tooling. They "
            f"begin a little off and ride {1e3 * study.long_ride.distance:.3g} mm. What turns, leaves the "
            "track or rolls back changes the mix that arrives."
        )
        yield Table(designs.long_ride(d["long_ride"]))
    rows = d["queues"]
    yield Table(frame({name: [row[name] for row in rows] for name in rows[0]}))
    worst = f"; most often: {study.robust.worst}" if study.robust.worst else ""
    yield Text(f"{study.robust.held} of {study.robust.draws} draws sort{worst}.")


DRIVE = (
    ("amplitude", units.MM, "mm"),
    ("frequency", 1.0, "Hz"),
    ("vibration_angle", units.DEG, "deg"),
    ("phase", units.DEG, "deg"),
)
TRACK = (
    ("radius", units.MM, "mm"),
    ("width", units.MM, "mm"),
    ("bank", units.DEG, "deg"),
    ("climb", units.DEG, "deg"),
)
SET, TAUGHT, SWAPPED = "set", "taught", "swapped"  # at the controller, at the sensor, by hand
NOTHING = "-"


def offers(study, settings, built=None):
    """Offer the files of a DesignStudy, as a list of Offer.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        As the user gave them.
    built : designing.design.Built, optional
        The machine below the bowl, and the bowl as a solid.

    Returns
    -------
    list of Offer
        Document, page and acceptance sheet; of a design with a bowl the bowl file, and everything of the
        tooling, of the machine and of the bowl as a solid. Of one that is not proved, or that delivers
        nothing, what was tried only: nothing to build from. Drawings of what falls short bear a mark.
    """
    if study.status == record.NOT_PROVED:
        return list(_unproved(study, settings))
    sheet, drawn = (None, None) if built is None else (built.sheet, built.drawn)
    files = [
        offer.document("design.json", designs.document, study),
        offer.table("design_trials.csv", designs.attempts, study),
        offer.table("alternatives.csv", designs.alternatives, study),
        offer.picture("design_history.png", "Each short trial of the loop", designs.history_figure, study),
    ]
    for item in study.risks:
        if item.pair is not None:
            files.append(
                offer.picture(f"risk_{item.kind}.png", item.text, designs.risk_picture, study.part, item)
            )
    if study.bowl is None:
        return [*files, offer.text("design.html", page, study, built)]
    files.append(offer.text("design.yaml", designs.bowl_file, study, settings, sheet))
    if not study.delivers:
        return [*files, offer.text("design.html", page, study, built)]
    tried = designs.trial_of(study)
    files.append(offer.table("acceptance.csv", designs.acceptance, study))
    if sheet is not None:
        files += machine.offers(sheet, tried)
    if drawn is not None:
        files += solidbowl.offers(drawn, tried)
        files.append(offer.document("bowl_solid.json", solidbowl.document, drawn.solid))
    if study.tooling is not None:
        own = tooling.offers(study.tooling, settings, mark=marking.of_trial(tried))
        files += [item for item in own if item.name != "tooling.yaml"]  # design.yaml has the devices
    files = [replace(item, make=cache(item.make)) for item in files]  # the page shows some of them
    return [*files, offer.text("design.html", page, study, built, files)]


def _unproved(study, settings) -> Iterator[Any]:
    """What is handed over of a design that was stopped."""
    yield offer.document("design.json", designs.document, study)
    yield offer.table("design_trials.csv", designs.attempts, study)
    if study.bowl is not None:
        yield offer.text("design.yaml", designs.bowl_file, study, settings)


def family_document(study) -> dict[Any, Any]:
    """Return a FamilyStudy as the JSON document."""
    return {
        "status": study.status,
        "shared": study.shared,
        "partial": study.partial,
        "parts": [designs.document(member) for member in study.members],
        "changeover": [
            {"what": what, "how": how, "values": dict(zip(_names(study), values))}
            for what, how, values in changes(study)
        ],
    }


def _names(study) -> list[Any]:
    return [member.part.name for member in study.members]


def changes(study) -> list[Any]:
    """Return what differs between the parts: rows of what, how it is changed, and a text for each part."""
    bowls = [member.bowl for member in study.members]
    if any(bowl is None for bowl in bowls):
        return []
    rows = [(f"track.{name}", SWAPPED, _values(bowls, "track", name, *how)) for name, *how in TRACK]
    rows += _devices(study)
    rows += [(f"drive.{name}", SET, _values(bowls, "drive", name, *how)) for name, *how in DRIVE]
    return [row for row in rows if len(set(row[2])) > 1]


def _values(bowls, section, name, unit, text) -> tuple[Any, ...]:
    return tuple(f"{getattr(getattr(bowl, section), name) / unit:.6g} {text}" for bowl in bowls)


def _devices(study) -> Iterator[Any]:
    """A row for each place of each kind: the first gap of all parts, the second, ..."""
    kinds = dict.fromkeys(device.kind for member in study.members for device in member.devices)
    for kind in kinds:
        own = [[device for device in member.devices if device.kind == kind] for member in study.members]
        for place, row in enumerate(zip_longest(*own), start=1):
            values = tuple(NOTHING if device is None else device.text for device in row)
            is_taught = (
                row[0] is not None and row[0].senses and len({device and device.sees for device in row}) == 1
            )
            yield f"{kind} {place}", TAUGHT if is_taught else SWAPPED, values


def changeover(study):
    """Return the list for the shop: a row for what is changed, a column for each part."""
    rows = changes(study)
    columns = {"what": [what for what, _, _ in rows], "how": [how for _, how, _ in rows]}
    columns |= {name: [values[k] for _, _, values in rows] for k, name in enumerate(_names(study))}
    return columns


def family_summary(study):
    """Return what is printed: a row for each part, then what is changed."""
    minute = units.PER_MINUTE
    rows = [("status", study.status), ("one bowl for all", "yes" if study.shared else "no")]
    for member in study.members:
        rate, low, _ = (value / minute for value in member.delivered)
        text = f"{member.status}, {member.wanted or NOTHING}"
        text += "" if member.partial else f", {rate:.4g} a minute (at least {low:.4g})"
        rows.append((member.part.name, text + (f": {member.why}" if member.why else "")))
        facts = designs.machine_facts(member)
        if facts is not None:
            rows.append((f"machine of {member.part.name}", designs.machine_text(facts)))
    for what, how, values in changes(study):
        rows.append((f"{how}: {what}", "; ".join(values)))
    return designs.two_columns([line for row in rows for line in designs.folded(*row)])


HOW = (
    "set: at the controller of the drive.",
    "taught: the sensor is shown the part that comes next.",
    "swapped: by hand, with the bowl at rest.",
)


def family_page(study):
    """Return the page of a FamilyStudy as HTML that needs no other file."""
    names = " and ".join(member.part.name for member in study.members)
    return html(
        Page(names, f"one bowl for several parts: {study.status}", tuple(_chapters(study)), kind="design")
    )


def _chapters(study) -> Iterator[Any]:
    answer = [Text(_family_status(study)), Table(frame(parts(study)))]
    answer += [Text("The machine that each part asks for:"), Notes(tuple(_machines(study)))]
    warned = tuple(
        dict.fromkeys(f"{member.part.name}: {line}" for member in study.members for line in member.warnings)
    )
    answer += [Notes(warned, loud=True)] if warned else []
    answer += [Notes(tuple(line), loud=True) for line in (_risks(study),) if line]
    yield Chapter(tuple(answer), tuple(_family_tiles(study)), anchor="answer", title="The answer")
    changed = changeover(study)
    if changed["what"]:
        sheet = frame(changed)
        blocks: tuple = (
            Table(sheet),
            CsvSheet("changeover.csv", text(sheet, "csv"), on_page=False),
            Heading("How"),
            Notes(HOW),
        )
    else:
        blocks = (Text("Nothing is changed from one part to the next."),)
    yield Chapter(blocks, anchor="changeover", title="Changeover")


def _family_status(study) -> str:
    if study.partial:
        return "It was stopped before all parts were designed."
    if study.shared and study.status == record.HOLDS:
        return (
            "One track and one chain of devices suit all parts: what is listed below is only set or taught."
        )
    if study.shared:
        return "One track and one chain of devices were tried with all parts, and do not hold for each."
    return "The parts do not share one chain: the list below names what is swapped."


def _family_tiles(study) -> Iterator[Any]:
    yield Tile("status", study.status, "the worst of all parts")
    yield Tile("one bowl for all", "yes" if study.shared else "no", "same track and same devices")
    rows = changes(study)
    by_hand = sum(how == SWAPPED for _, how, _ in rows)
    yield Tile("changed", f"{len(rows)}", f"{by_hand} of them by hand")


def _machines(study) -> Iterator[Any]:
    for member in study.members:
        facts = designs.machine_facts(member)
        text = "no bowl" if facts is None else designs.machine_text(facts)
        yield f"{member.part.name}: {text}"


def _risks(study) -> list[Any]:
    return [f"{member.part.name}: {risk.text}" for member in study.members for risk in member.risks]


def parts(study) -> dict[Any, Any]:
    """Return columns of what each part delivers, and where its own page is."""
    rows = []
    for member in study.members:
        d = designs.document(member)
        rows.append(
            {
                "part": member.part.name,
                "status": d["status"],
                "leaves as": d["wanted"] or NOTHING,
                "asked_per_minute": d["target_per_minute"],
                "delivered_per_minute": d["delivered_per_minute"],
                "at_least_per_minute": d["delivered_low"],
                "purity": d["purity"],
                "jams": d["jams"],
                "devices": ", ".join(device["device"] for device in d["chain"]) or "none",
                "page": f"{member.part.name}/design.html",
            }
        )
    return {name: [row[name] for row in rows] for name in rows[0]}


def family_offers(study) -> list[Any]:
    """Offer the files of a FamilyStudy itself, as a list of Offer; each part has its own folder."""
    if study.partial:  # nothing to build from
        return [offer.document("family.json", family_document, study)]
    return [
        offer.document("family.json", family_document, study),
        offer.table("changeover.csv", changeover, study),
        offer.text("family.html", family_page, study),
    ]
