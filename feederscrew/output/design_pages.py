"""The page and the files of ``feeder design``, of one part and of a family of parts."""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import zip_longest
from typing import Any

from feederscrew.base import units
from feederscrew.base.columns import ColumnHead, Document, Frame, share_head
from feederscrew.bowl.arguments import settings_of
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import Setting
from feederscrew.bowl.verified import (
    AMONG,
    DRAWS_HELD,
    HANGING,
    HELD,
    PURE,
    RATE_KEPT,
    SHOWN_PURITY,
    Status,
    Verified,
)
from feederscrew.designing import texts, verdict_texts
from feederscrew.designing.design import Built
from feederscrew.designing.families import FamilyStudy
from feederscrew.designing.next_tries import next_tries
from feederscrew.designing.record import DesignStudy
from feederscrew.machine.sheet import MachineSheet
from feederscrew.output import (
    beside_bowl,
    designs,
    machine,
    marking,
    poses,
    solidbowl,
    solidbowl_views,
    tables,
    tooling,
    tooling_drawing,
)
from feederscrew.output import offers as offer
from feederscrew.output.designs import LOWER_BOUND
from feederscrew.output.next_tries import reason
from feederscrew.output.offers import RecordView
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import (
    Block,
    Chapter,
    Code,
    CsvSheet,
    Folded,
    Heading,
    MarkedCell,
    Matrix,
    Notes,
    Page,
    Picture,
    Pose,
    Table,
    Text,
    Tile,
    Views,
)
from feederscrew.output.record_lines import design_text, family_text
from feederscrew.output.style import png
from feederscrew.output.trial import rides
from feederscrew.output.trial.tables import queues_table
from feederscrew.resting.aspects import find

MEASURE = (
    "Stroke: a stroke gauge, a printed sticker on the bowl's rim, shows it peak to peak; if it is below the "
    "computed one, raise the controller, and look for a part that touches the frame.",
    "Acceleration: an accelerometer on the bowl, along the vibration; where the stroke is right and the "
    "acceleration is not, the frequency is another one.",
    "Natural frequency: tap the bowl with the drive off and read the decay; it shall lie 3 to 8 % above the "
    "drive: add a leaf or take one off.",
    "Friction: lay a part on a strip of the track's sheet and tilt it until it slides; oil brings it down, "
    "and the rate with it.",
)
SHOP = (  # what a shop reads of the machine, rows of its summary
    "vibration angle [deg]",
    "leaves",
    "springs",
    "natural frequency [Hz]",
    "above the drive [%], gain",
    "leaf stress [MPa]",
    "force of the magnet [N]",
)
FILES = {  # by ending: what they are
    "pdf": "sheets of the bowl, its springs, its tooling and the sheet development of its track",
    "dxf": "drawing with dimensions, to cut from",
    "svg": "the same drawing, to look at",
    "step": "solid with exact faces",
    "3mf": "solid to print, in mm",
    "stl": "solid as a mesh, in mm",
    "yaml": "bowl file for the other commands of feeder",
}
TOOLING_PICTURES = (
    ("tooling_3d.png", "The part over the cut: what leaves, and what falls by least"),
    ("tooling.png", "Each orientation at each device, and the section in which it leaves"),
    ("tooling.svg", "The tooling unrolled, with its dimensions, and as it is bent"),
)


QUICK_WORDS = (
    "This is a quick look for a quotation. The chain is the first of a few short trials, and its bound says "
    "what no chain exceeds. No draw and no queue was run: nothing is proved, and nothing is built from it."
)


def page(study: DesignStudy, build: Built | None = None, papers: Sequence[offer.Offer] = ()) -> str:
    """Return the page of a design as HTML that needs no other file.

    Parameters
    ----------
    study : DesignStudy
    build : Built, optional
        The machine below the bowl, and the bowl as a solid.
    papers : sequence of Offer, optional
        The other files of the design: some are shown, and those to build from have a link.

    Returns
    -------
    str
    """
    d = designs.document(study)
    value, low, high = (d[f"delivered_{end}"] for end in ("per_minute", "low", "high"))
    purity = "-" if d["purity"] is None else f"{100.0 * d['purity']:.3g} %"
    tiles: tuple[Tile, ...] = (Tile("status", d["status"], d["wanted"] or "no orientation"),)
    if study.status is Status.NOT_PROVED:
        tiles += _quick_tiles(d["quick"])
    else:
        purity_low = f"seen at the worst fill; {LOWER_BOUND} {100.0 * d['purity_low']:.3g} %"
        rates = f"{low:.3g} to {high:.3g} (95 %) at the worst fill, asked {d['target_per_minute']:.3g}"
        tiles += (
            Tile("parts per minute", f"{value:.3g}", rates),
            Tile("purity", purity, purity_low),
            Tile("jams", f"{d['jams']}", f"in {d['queue_seconds']:.3g} s of queue"),
        )
    chapters = [Chapter(tuple(_answer(study, d)), tiles, study.warnings, "answer", "The answer")]
    if build is not None and study.delivers:
        chapters += _to_build(study, build, offer.by_name(papers))
    loop_words = (
        "Each line is one short trial: a chain on its bowl, every orientation that comes often enough. "
        "What goes wrong in it is changed in the next. The velocity is the mean of its parts; that of "
        "the machine is computed for a point."
    )
    if not study.request.quick:  # which writes no such table
        loop_words += " design_trials.csv has the dimensions of each device."
    loop: list[Block] = [Text(loop_words)]
    if study.attempts:
        drawn, alt = png(designs.history_figure(study)), "Each short trial of the loop"
        loop += [Table(designs.short_attempts(study)), Picture("design_history.png", drawn, alt)]
    chapters.append(Chapter(tuple(loop), anchor="loop", title="The loop"))
    if study.trials:
        scene, captions = rides.scene(study.part, *study.trials)
        played = tuple((*caption, ()) for caption in captions)
        lead = Text("Parts of the short trial at the device that decides.")
        views = Views(scene, played, "trial-views", "Orientation", plays=True, printed=True)
        chapters.append(Chapter((lead, views), anchor="trial", title="The trial"))
    if study.proof.queues:
        lead = Text(
            "A queue of parts that push each other, at three fills, and draws of part, friction, drive and "
            "cuts, each tried with parts of its own. The worst fill counts: each was followed until it held "
            "or was refused."
        )
        proof: list[Block] = [lead]
        if d["long_ride"] and study.proof.long_ride is not None:
            ridden = Text(
                "A few parts of each orientation that comes often travel on bare track, up to the tooling. "
                f"They begin a little off and travel {1e3 * study.proof.long_ride.distance:.3g} mm. "
                "What turns, leaves the track or rolls back changes the mix that arrives."
            )
            proof += [ridden, Table(designs.long_ride(study.proof.long_ride.rows()))]
        most = f"; most often: {study.proof.robust.main_fault_text}" if study.proof.robust.main_fault else ""
        draws = Text(f"{study.proof.robust.held} of {study.proof.robust.draws} draws sort{most}.")
        proof.append(Table(queues_table(d["queues"])))
        if d["differences"]:
            proof.append(Notes(tuple(item["text"] for item in d["differences"]), loud=True))
        proof.append(draws)
        chapters.append(Chapter(tuple(proof), anchor="proof", title="The proof"))
    if study.delivers:  # else there is nothing to build from, nothing to accept
        sheet = designs.acceptance(study)
        blocks = (
            Text(
                "Each line has its demand (low, high) and the plan that shows it for 95 % confidence. Beside "
                "it stands what the computation expects, with its bounds: of a rate the 95 % interval, of "
                "yield and jams one-sided bounds (95 %). Write what was measured, and in 'sample' on how "
                "many parts (of a yield) or in how many seconds (of a rate and of jams)."
            ),
            Table(sheet),
            CsvSheet("acceptance.csv", tables.text(sheet, "csv"), on_page=False),
            Heading("What to measure"),
            Notes(MEASURE),
        )
        chapters.append(Chapter(blocks, anchor="acceptance", title="Acceptance sheet"))
    aspects = find(study.part) if study.tooling is None else study.tooling.aspects
    return html(
        Page(
            study.part.name,
            f"design of a bowl: {study.status}",
            tuple(chapters),
            "design",
            poses.opening(study.part, aspects, first_seen(study)),
            poses.pose_finder(study.part, aspects),
        )
    )


def _quick_tiles(quick: Mapping[str, Any] | None) -> tuple[Tile, ...]:
    """The bound on the rate and the short trial of a quick look."""
    if quick is None:
        return ()
    bound = Tile("at most per minute", f"{quick['at_most_per_minute']:.3g}", f"{quick['wanted']}, not proved")
    if quick["short_trial_per_minute"] is None:
        return (bound,)
    word = "clean" if quick["clean"] else "not clean"
    trial = Tile(
        "its short trial, per minute", f"{quick['short_trial_per_minute']:.3g}", f"{word}, not proved"
    )
    return bound, trial


def first_seen(study: DesignStudy) -> list[tuple[str, str]]:
    """Return what was wanted, with what became of it, then what left in its place, or what to try instead.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    list of (str, str)
        Orientations or aspects with words for each, those that the picture of a page opens with.
    """
    wanted, tooling = (study.wanted or "").split(AMONG)[0], study.tooling
    arrives = None if tooling is None or tooling.wanted is None else tooling.orientations[tooling.wanted].name
    if study.delivers:
        words = "leaves correctly oriented"
        instead = texts.leaving_texts(study.proof.left_instead)
        others = sorted((name for name in instead if name != wanted), key=lambda name: -instead[name])
        seen = [(name, f"not wanted: {instead[name]} left so") for name in others[:1]]
        if wanted == HANGING and arrives:  # no pose on a face
            wanted, words = arrives, "arrives so, leaves hanging by its head"
        return [(wanted, words), *seen]
    tried = study.wanted_trials
    seen = []
    for one in sorted(tried, key=lambda one: one.wanted != wanted)[:2]:
        words = texts.wanted_trials_text("wanted", one.trials, one.ends, one.others, one.clean_rate)
        hangs = one.wanted == HANGING and arrives
        seen.append((arrives, f"arrives so; {words}") if hangs and arrives else (one.wanted, words))
    aspects = {name.partition("@")[0] for name, _ in seen}
    if study.quick is not None and all(name == HANGING for name, _ in seen):  # what the bound is of
        return [(study.quick.wanted, "may bring most; not tried to its end")]
    instead_of_it = (one for one in next_tries(study) if one.aspect and one.aspect not in aspects)
    return [*seen, *((one.aspect, f"to try: {reason(one)}") for one in itertools.islice(instead_of_it, 1))]


def _what_to_try(study: DesignStudy, d: Mapping[str, Any]) -> Iterator[Block]:
    """Yield what was wanted and where it was lost, then the calls that may hold, to be pasted."""
    tried = study.wanted_trials
    if tried and not study.delivers:
        yield Text("What was wanted, and what its short trials did:")
        yield Notes(tuple(map(verdict_texts.trials_text, tried)))
    if d["next"]:
        yield Heading("What to try")
    for entry in d["next"]:
        yield Text(f"{entry['why'][0].upper()}{entry['why'][1:]}:")
        yield Code(entry["command"])


def _answer(study: DesignStudy, d: Mapping[str, Any]) -> Iterator[Block]:
    """Return the page's answer: the status, what is missing or reached; machine, bowl, risks."""
    if study.status in HELD:
        if study.condition:
            yield Notes((f"{study.status}: {study.condition}.",), loud=True)
        least, draws = 60.0 * RATE_KEPT * study.request.target, 100.0 * DRAWS_HELD
        yield Text(
            f"Status: {study.status}. At each fill the lower end of the rate's 95 % interval is at least "
            f"{least:.3g} a minute, the purity that was seen at least {100.0 * PURE:.3g} %, and its "
            f"{LOWER_BOUND} above {100.0 * SHOWN_PURITY:.3g} %. Nothing jams, and at least {draws:.3g} % of "
            "the draws sort."
        )
        for entry in d["next"]:
            yield Text(f"{entry['why'][0].upper()}{entry['why'][1:]}:")
            yield Code(entry["command"])
    else:
        yield from _what_to_try(study, d)
        is_quick = study.request.quick
        yield Heading("What this answer is" if is_quick else "Why it does not hold")
        yield Text(f"Status: {study.status}.")
        quick_lines = (QUICK_WORDS, *verdict_texts.proved_so_far(study))
        yield Notes(quick_lines if is_quick else verdict_texts.reason_lines(study), loud=is_quick)
        if study.nearest is not None:
            yield Text(f"The nearest that holds: {study.nearest.sentence}.")
    if d["machine"]:
        yield Text(f"The machine: {designs.machine_text(d['machine'])}.")
    yield Table(tables.quantities(designs.outcome(d, study.devices)))
    if study.alternatives:
        yield Heading("Cheapest first: steel (1), steady air (2), a sensor with a valve (3)")
        yield Table(designs.short_alternatives(study))
    if d["bowl"]:
        yield Table(tables.quantities(designs.dimensions(d)))
    if study.risks:
        yield Notes(tuple(risk.text for risk in study.risks), loud=True)
    for risk in study.risks:  # between two parts, or a part and two walls
        if risk.pair is not None:
            drawn = png(designs.risk_picture(study.part, risk))
            yield Picture(f"risk_{risk.kind}.png", drawn, risk.text, printed=True)


def _to_build(study: DesignStudy, build: Built, papers: Mapping[str, offer.Offer]) -> Iterator[Chapter]:
    """Return the documents that a shop builds from: bowl, tooling, springs, drive, and their files."""
    mark = marking.of_trial(designs.trial_of(study))
    views = solidbowl_views.blocks(build.drawn.solid if build.drawn else None, study.part, build.why, mark)
    yield Chapter(tuple(views), anchor="bowl", title="The bowl")
    drawn = [
        Picture(name, tables.file_bytes(papers[name].make()), alt)
        for name, alt in TOOLING_PICTURES
        if name in papers
    ]
    if drawn:
        lead = Text("The part over the cut, what each device does, and the drawing of the cuts.")
        yield Chapter((lead, *drawn, *_shop_work(build)), anchor="tooling", title="The tooling")
    beside = None if build.drawn is None else beside_bowl.find_beside(build.drawn, designs.trial_of(study))
    if beside is not None:
        lead = Text("What is bought and set beside the bowl: bowl.pdf shows where it stands.")
        yield Chapter((lead, Table(beside_bowl.table(beside))), anchor="beside", title="Beside the bowl")
    if build.sheet is not None:
        rows = [row for row in machine.summary(build.sheet).rows() if row["quantity"] in SHOP]
        blocks: list[Block] = [Table(Frame.of_rows(rows, ("quantity", "value")))]
        if drawing := papers.get("bowl.png"):
            blocks.append(Picture(drawing.name, tables.file_bytes(drawing.make()), drawing.alt))
        yield Chapter(tuple(blocks), anchor="springs", title="Springs and drive")
    listed = [(name, FILES.get(name.rpartition(".")[2])) for name in papers]
    cells = tuple((MarkedCell(name, link=name), MarkedCell(what)) for name, what in listed if what)
    if cells:
        files = Text("These files lie beside this page."), Matrix(("file", "what it is"), cells)
        bowl = papers.get("design.yaml")
        text = "" if bowl is None else tables.file_bytes(bowl.make()).decode()
        folded = (Folded("design.yaml, the bowl file", text),) if text else ()
        yield Chapter((*files, *folded), anchor="files", title="Files to build from")


def _shop_work(build: Built) -> list[Block]:
    """What the shop must do to the cuts of a bowl beside cutting their outlines."""
    solid = None if build.drawn is None else build.drawn.solid
    if solid is None or solid.plan.stretch is None:
        return []
    work = tooling_drawing.shop_table(solid.plan.stretch)
    lead = Text("What the shop does to each cut beside cutting its outline.")
    return [lead, Table(work)] if list(work.rows()) else []


def offers(study: DesignStudy, settings: Sequence[Setting], build: Built | None = None) -> list[offer.Offer]:
    """Offer the files of a design.

    They are document, page and acceptance sheet; of a design with a bowl the bowl file, and everything of the
    tooling, of the machine and of the bowl as a solid. Of one that is not proved, or that delivers nothing,
    what was tried only: nothing to build from. Drawings of what falls short bear a mark.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        As the user gave them.
    build : Built, optional
        The machine below the bowl, and the bowl as a solid.

    Returns
    -------
    list of Offer
    """
    sheet, drawn = (None, None) if build is None else (build.sheet, build.drawn)
    files = [offer.document("design.json", designs.document, study)]
    if not study.request.quick:  # its table of trials would bear no mark
        files.append(offer.table("design_trials.csv", designs.attempts, study))
    if study.bowl is not None:
        files.append(offer.text("design.yaml", designs.bowl_file, study, settings, sheet))
    if study.request.quick:
        return [*files, offer.text("design.html", page, study, build)]
    if study.status == Status.NOT_PROVED:
        return files
    files += [
        offer.table("alternatives.csv", designs.alternatives, study),
        offer.picture("design_history.png", "Each short trial of the loop", designs.history_figure, study),
        *(
            offer.picture(f"risk_{item.kind}.png", item.text, designs.risk_picture, study.part, item)
            for item in study.risks
            if item.pair is not None
        ),
    ]
    if study.bowl is None or not study.delivers:
        return [*files, offer.text("design.html", page, study, build)]
    trial = designs.trial_of(study)
    files.append(offer.table("acceptance.csv", designs.acceptance, study))
    if sheet is not None:
        files += machine.offers(sheet, trial)
    if drawn is not None:
        files += solidbowl.offers(drawn, trial)
        files.append(offer.document("bowl_solid.json", _solid_document, drawn, trial))
    if study.tooling is not None:
        own = tooling.offers(study.tooling, settings, mark=marking.of_trial(trial))
        files += [item for item in own if item.name != "tooling.yaml"]  # design.yaml has the devices
    files = [replace(item, make=cache(item.make)) for item in files]  # the page shows some of them
    return [*files, offer.text("design.html", page, study, build, files)]


def _solid_document(drawn: MachineSheet, trial: Verified | None) -> Document:
    """The bowl as a solid, and what stands beside it."""
    own = {} if drawn.solid is None else solidbowl.document(drawn.solid)
    return own | beside_bowl.document(beside_bowl.find_beside(drawn, trial))


# --- A family: several parts, one bowl or a bowl for each ---

CHANGEABLE = {  # keys of the bowl, by section
    "track": ("radius", "width", "bank", "climb"),
    "drive": ("amplitude", "frequency", "vibration_angle", "phase"),
}
SET = "set"  # at the controller
TAUGHT = "taught"  # at the sensor
SWAPPED = "swapped"  # by hand
Change = tuple[str, str, tuple[str, ...]]  # what, how it is changed, and a text for each part


def family_document(study: FamilyStudy) -> Document:
    """Return the design of a family as the JSON document, ``family.json``.

    Parameters
    ----------
    study : FamilyStudy

    Returns
    -------
    dict
        ``parts`` holds the document of each design, ``changeover`` what is changed between them.
    """
    names = [member.part.name for member in study.members]
    return {
        "status": study.status,
        "shared": study.shared,
        "partial": study.partial,
        "parts": [designs.document(member) for member in study.members],
        "changeover": [
            {"what": what, "how": how, "values": dict(zip(names, values))}
            for what, how, values in _changes(study)
        ],
    }


def _changes(study: FamilyStudy) -> list[Change]:
    bowls = [member.bowl for member in study.members]
    if any(bowl is None for bowl in bowls):
        return []

    def values(section: str, how: str) -> list[Change]:
        names = [f"{section}.{word}" for word in CHANGEABLE[section]]
        parts = [getattr(bowl, section) for bowl in bowls]
        return [(name, how, tuple(designs.value_text(part, name, 6) for part in parts)) for name in names]

    # a row for each place of each kind of device: the first gap of all parts, the second, ...
    rows = values("track", SWAPPED)
    for kind in dict.fromkeys(device.kind for member in study.members for device in member.devices):
        own = [[d for d in list[Any](member.devices) if d.kind == kind] for member in study.members]
        for place, row in enumerate(zip_longest(*own), start=1):
            first = row[0]
            views = (
                {device and device.sees for device in row}
                if first is not None and first.action is Action.SENSE
                else ()
            )
            texts = tuple("-" if device is None else device.text for device in row)
            rows.append((f"{kind} {place}", TAUGHT if len(views) == 1 else SWAPPED, texts))
    return [row for row in [*rows, *values("drive", SET)] if len(set(row[2])) > 1]


def changeover(study: FamilyStudy) -> dict[str, list[str]]:
    """Return the list for the shop of what is changed from one part to the next.

    Parameters
    ----------
    study : FamilyStudy

    Returns
    -------
    dict of str to list of str
        Columns ``what`` and ``how``, and one for each part; empty where a part has no bowl.
    """
    rows = _changes(study)
    columns = {"what": [what for what, _, _ in rows], "how": [how for _, how, _ in rows]}
    names = (member.part.name for member in study.members)
    return columns | {name: [values[k] for _, _, values in rows] for k, name in enumerate(names)}


def family_summary(study: FamilyStudy) -> Frame:
    """Return what is printed: a row for each part, then what is changed.

    Parameters
    ----------
    study : FamilyStudy

    Returns
    -------
    Frame
    """
    rows = [("status", study.status), ("one bowl for all", "yes" if study.shared else "no")]
    for member in study.members:
        rate, low, _ = (value / units.PER_MINUTE for value in member.proof.delivered)
        text = f"{member.status}, {member.wanted or '-'}"
        text += "" if member.partial else f", {rate:.4g} a minute (95 % interval from {low:.4g})"
        rows.append((member.part.name, text + (f": {member.why}" if member.why else "")))
        facts = designs.machine_facts(member)
        if facts is not None:
            rows.append((f"machine of {member.part.name}", designs.machine_text(facts)))
    rows += [(f"{how}: {what}", "; ".join(values)) for what, how, values in _changes(study)]
    return tables.quantities(line for row in rows for line in designs.wrap_row(*row))


def family_page(study: FamilyStudy) -> str:
    """Return the page of a family as HTML that needs no other file.

    Parameters
    ----------
    study : FamilyStudy

    Returns
    -------
    str
    """
    if study.partial:
        status = "It was stopped before all parts were designed."
    elif not study.shared:
        status = "The parts do not share one chain: the list below names what is swapped."
    elif study.status in HELD:
        status = (
            "One track and one chain of devices suit all parts: what is listed below is only set or taught."
        )
    else:
        status = "One track and one chain of devices were tried with all parts, and do not hold for each."
    machines, warned, risks, rows = [], dict[str, None](), [], []
    views, pose_of = list[Views](), dict[str, Callable[[str], Pose | None]]()
    for member in study.members:
        name, d = member.part.name, designs.document(member)
        aspects = find(member.part) if member.tooling is None else member.tooling.aspects
        views += poses.opening(member.part, aspects, first_seen(member)[:1], of=name)
        pose_of[name] = poses.pose_finder(member.part, aspects)
        facts = d["machine"]
        machines.append(f"{name}: {'no bowl' if facts is None else designs.machine_text(facts)}")
        warned |= dict.fromkeys(f"{name}: {poses.name_part(line, name)}" for line in member.warnings)
        risks += [f"{name}: {poses.name_part(risk.text, name)}" for risk in member.risks]
        rows.append(
            {
                "part": name,
                "status": d["status"],
                "leaves as": poses.name_part(d["wanted"] or "-", name),
                "asked_per_minute": d["target_per_minute"],
                "delivered_per_minute": d["delivered_per_minute"],
                "at_least_per_minute": d["delivered_low"],
                "purity": d["purity"],
                "jams": d["jams"],
                "devices": ", ".join(device["device"] for device in d["chain"]) or "none",
                "page": f"{name}/design.html",
            }
        )
    paces = ("asked_per_minute", "delivered_per_minute", "at_least_per_minute")
    above = {name: ColumnHead.of_name(name, "1/min") for name in paces} | {"purity": share_head("purity")}
    answer: list[Block] = [Text(status), Table(Frame.of_rows(rows).headed(above))]
    answer += [Text("The machine that each part asks for:"), Notes(tuple(machines))]
    answer += [Notes(tuple(lines), loud=True) for lines in (warned, risks) if lines]
    changes, changed = _changes(study), Frame.of(changeover(study))
    by_hand = sum(how == SWAPPED for _, how, _ in changes)
    tiles = (
        Tile("status", study.status, "the worst of all parts"),
        Tile("one bowl for all", "yes" if study.shared else "no", "same track and same devices"),
        Tile("changed", f"{len(changes)}", f"{by_hand} of them by hand"),
    )
    blocks: list[Block] = [Text("Nothing is changed from one part to the next.")]
    if changes:
        named = {
            column: [poses.name_part(text, column) if column in pose_of else text for text in texts]
            for column, texts in changeover(study).items()
        }
        sheet = CsvSheet("changeover.csv", tables.text(changed, "csv"), on_page=False)
        how = (
            "set: at the controller of the drive.",
            "taught: the sensor is shown the part that comes next.",
            "swapped: by hand, with the bowl at rest.",
        )
        blocks = [Table(Frame.of(named)), sheet, Heading("How"), Notes(how)]
    chapters = (
        Chapter(tuple(answer), tiles, anchor="answer", title="The answer"),
        Chapter(tuple(blocks), anchor="changeover", title="Changeover"),
    )
    names = " and ".join(member.part.name for member in study.members)
    subtitle = f"one bowl for several parts: {study.status}"
    return html(Page(names, subtitle, chapters, "design", tuple(views), pose_of=pose_of))


def family_offers(study: FamilyStudy) -> list[offer.Offer]:
    """Offer the files of a family itself; each part has its own folder.

    Parameters
    ----------
    study : FamilyStudy

    Returns
    -------
    list of Offer
        Of one that was stopped, the document alone.
    """
    files = [offer.document("family.json", family_document, study)]
    if study.partial:  # nothing to build from
        return files
    changed = offer.table("changeover.csv", changeover, study)
    return [*files, changed, offer.text("family.html", family_page, study)]


def _files_with_machine(study: DesignStudy) -> list[offer.Offer]:
    """The files of a design, with the machine below its bowl."""
    from feederscrew.designing.design import Built, build_machine, with_machine

    settings = () if study.bowl is None else settings_of(study.bowl)
    built = Built() if study.partial else build_machine(study, settings)
    return offers(with_machine(study, built), settings, built)


DESIGN_VIEW = RecordView(design_text, lambda study: offers(study, ()), "design", _files_with_machine)
FAMILY_VIEW = RecordView(family_text, family_offers, "design")
